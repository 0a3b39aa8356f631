#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>What Meta's SDK says of one hand. Calls that fail log an error each, so nothing is asked while the
    /// session has no input focus or the hand holds nothing, and after a failure not until that changes.</summary>
    internal sealed class MetaController
    {
        // The name of what is held is a new string at each call.
        private const double AskProfileSeconds = 2.0;
        private const string MxInk = "mx_ink";

        private readonly OVRPlugin.Hand hand;
        private OVRInput.Controller connected;
        private bool hadFocus;
        private bool holdsMxInk;
        private bool hasFailed;
        private double askProfileAtSeconds;

        public MetaController(HapticHand hand)
        {
            bool left = hand == HapticHand.Left;
            this.hand = left ? OVRPlugin.Hand.HandLeft : OVRPlugin.Hand.HandRight;
            Mask = left ? OVRInput.Controller.LTouch : OVRInput.Controller.RTouch;
        }

        public OVRInput.Controller Mask { get; }

        public OVRPlugin.Hand Hand => hand;

        /// <summary>Another number whenever what was learnt may be wrong.</summary>
        public int Version { get; private set; }

        /// <summary>A Touch controller is in the hand, and no call to it has failed.</summary>
        public bool HoldsTouch => Look() && !holdsMxInk && (connected & Mask) != 0;

        /// <summary>An MX Ink is in the hand, and no call to it has failed.</summary>
        public bool HoldsMxInk => Look() && holdsMxInk;

        /// <summary>A call failed: nothing is asked until something changes.</summary>
        public void Fail() => hasFailed = true;

        private bool Look()
        {
            bool hasFocus = OVRPlugin.hasInputFocus;
            OVRInput.Controller now = OVRInput.GetConnectedControllers();
            double seconds = Time.realtimeSinceStartupAsDouble;
            if (hasFocus != hadFocus || now != connected)
            {
                hadFocus = hasFocus;
                connected = now;
                Change();
                askProfileAtSeconds = 0.0;
            }
            if (hasFocus && seconds >= askProfileAtSeconds)
            {
                askProfileAtSeconds = seconds + AskProfileSeconds;
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
