using UnityEngine.InputSystem.XR;
using UnityEngine.XR.OpenXR.Input;

namespace UnityShim
{
    /// <summary>What both hands hold, in every package that knows of controllers.</summary>
    public static class HeldDevices
    {
        /// <summary>Empty hands, and nothing recorded of what they were sent.</summary>
        public static void Reset()
        {
            OVRPlugin.Reset();
            OVRInput.Reset();
            OpenXRInput.Reset();
            XrHand.Reset();
            XRControllerWithRumble.Drop();
        }

        /// <summary>A Touch controller in the right hand that takes waves, and parametric haptics from 60 to 400 Hz.</summary>
        public static void TakeTouchController()
        {
            OVRInput.Connected = OVRInput.Controller.RTouch;
            OVRInput.Properties = new OVRInput.HapticsParametricProperties
            {
                IdealFrameSubmissionRate = 20000000L,
                MinimumFirstFrameDuration = 40000000L,
                MinFrequencyHz = 60f,
                MaxFrequencyHz = 400f,
            };
        }
    }
}
