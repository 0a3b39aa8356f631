#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>What one hand holds, by Meta's runtime. Asks OVRPlugin only, which needs no OVRManager in the scene;
    /// OVRInput's list of controllers would. Main thread; makes a string every two seconds.</summary>
    internal sealed class MetaHand
    {
        // The SDK returns the profile's name as a new string at each call.
        private const double ProfileIntervalSeconds = 2.0;
        private const string MxInk = "mx_ink";

        private readonly DisguisedMxInk disguise = new DisguisedMxInk();
        private OVRPlugin.Controller connected;
        private double nextProfileSeconds;

        public MetaHand(HapticHand hand)
        {
            bool left = hand == HapticHand.Left;
            Hand = left ? OVRPlugin.Hand.HandLeft : OVRPlugin.Hand.HandRight;
            Mask = left ? OVRPlugin.Controller.LTouch : OVRPlugin.Controller.RTouch;
        }

        public OVRPlugin.Hand Hand { get; }

        public OVRPlugin.Controller Mask { get; }

        /// <summary>True while the session runs with input focus. Without it calls to actions fail and log an error.
        /// </summary>
        public bool HasFocus { get; private set; }

        /// <summary>True while a controller that the runtime counts as the hand's is connected, or an MX Ink.</summary>
        public bool IsConnected => (connected & Mask) != 0;

        /// <summary>True while an MX Ink is in the hand and the project has its action set.</summary>
        public bool HoldsMxInk { get; private set; }

        /// <summary>True while the Touch controller in the hand is an MX Ink without its action set.</summary>
        public bool HoldsDisguisedMxInk => disguise.IsRecognised;

        /// <summary>Increases with each change of session, controllers or profile: a failed call may succeed.</summary>
        public int Version { get; private set; }

        /// <summary>Reads the present state. Call it before the properties; several calls in a frame are cheap.</summary>
        public void Refresh()
        {
            bool focus = OVRPlugin.hasInputFocus;
            OVRPlugin.Controller now = OVRPlugin.GetConnectedControllers();
            double seconds = Time.realtimeSinceStartupAsDouble;
            if (focus != HasFocus || now != connected)
            {
                HasFocus = focus;
                connected = now;
                nextProfileSeconds = 0.0;
                disguise.Forget();
                ++Version;
            }
            if (!HasFocus)
            {
                return;
            }
            if (seconds >= nextProfileSeconds)
            {
                nextProfileSeconds = seconds + ProfileIntervalSeconds;
                RefreshProfile();
            }
            if (IsConnected && !HoldsMxInk && !disguise.IsRecognised)
            {
                NoteStick(seconds);
            }
        }

        private void RefreshProfile()
        {
            string profile = OVRPlugin.GetCurrentInteractionProfileName(Hand) ?? "";
            bool isPen = profile.IndexOf(MxInk, StringComparison.OrdinalIgnoreCase) >= 0;
            if (isPen != HoldsMxInk)
            {
                HoldsMxInk = isPen;
                disguise.Forget();
                ++Version;
            }
        }

        private void NoteStick(double seconds)
        {
            OVRPlugin.ControllerState4 state = OVRPlugin.GetControllerState4((uint)Mask);
            bool left = Hand == OVRPlugin.Hand.HandLeft;
            OVRPlugin.Vector2f stick = left ? state.LThumbstick : state.RThumbstick;
            OVRInput.RawTouch touch = left ? OVRInput.RawTouch.LThumbstick : OVRInput.RawTouch.RThumbstick;
            disguise.Note(new Vector2(stick.x, stick.y), (state.Touches & (uint)touch) != 0u, seconds);
            Version += disguise.IsRecognised ? 1 : 0;
        }
    }
}
