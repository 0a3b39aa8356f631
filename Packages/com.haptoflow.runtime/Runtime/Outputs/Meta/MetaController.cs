#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The state of one hand in Meta's SDK. Failing calls log an error each, so no call is made while the
    /// session has no input focus or the hand is empty, and none after a failure until the state changes.</summary>
    internal sealed class MetaController
    {
        // The SDK returns the profile's name as a new string at each call.
        private const double ProfileIntervalSeconds = 2.0;
        private const string MxInk = "mx_ink";

        private readonly OVRPlugin.Hand hand;
        private OVRInput.Controller connected;
        private bool hadFocus;
        private bool holdsMxInk;
        private bool hasFailed;
        private double nextProfileSeconds;

        public MetaController(HapticHand hand)
        {
            bool left = hand == HapticHand.Left;
            this.hand = left ? OVRPlugin.Hand.HandLeft : OVRPlugin.Hand.HandRight;
            Mask = left ? OVRInput.Controller.LTouch : OVRInput.Controller.RTouch;
        }

        public OVRInput.Controller Mask { get; }

        public OVRPlugin.Hand Hand => hand;

        /// <summary>Increases whenever cached capabilities may be out of date.</summary>
        public int Version { get; private set; }

        /// <summary>True while a Touch controller is in the hand and no call to it has failed.</summary>
        public bool HoldsTouch => Refresh() && !holdsMxInk && (connected & Mask) != 0;

        /// <summary>True while an MX Ink is in the hand and no call to it has failed.</summary>
        public bool HoldsMxInk => Refresh() && holdsMxInk;

        /// <summary>Stops calls after a failure until the state changes.</summary>
        public void Fail() => hasFailed = true;

        private bool Refresh()
        {
            bool hasFocus = OVRPlugin.hasInputFocus;
            OVRInput.Controller now = OVRInput.GetConnectedControllers();
            double seconds = Time.realtimeSinceStartupAsDouble;
            if (hasFocus != hadFocus || now != connected)
            {
                hadFocus = hasFocus;
                connected = now;
                Change();
                nextProfileSeconds = 0.0;
            }
            if (hasFocus && seconds >= nextProfileSeconds)
            {
                nextProfileSeconds = seconds + ProfileIntervalSeconds;
                string profile = OVRPlugin.GetCurrentInteractionProfile(hand) ?? "";
                bool isPen = profile.IndexOf(MxInk, StringComparison.OrdinalIgnoreCase) >= 0;
                if (isPen != holdsMxInk)
                {
                    holdsMxInk = isPen;
                    Change();
                }
            }
            return hasFocus && !hasFailed;
        }

        private void Change()
        {
            hasFailed = false;
            ++Version;
        }
    }
}
