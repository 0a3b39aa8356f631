using UnityEngine.InputSystem;
using UnityEngine.InputSystem.XR;
using UnityEngine.XR.OpenXR.Input;

namespace UnityShim
{
    /// <summary>The devices in both hands, for all packages that support controllers.</summary>
    public static class HeldDevices
    {
        /// <summary>Empties both hands and clears the recorded output.</summary>
        public static void Reset()
        {
            OVRPlugin.Reset();
            OVRInput.Reset();
            OpenXRInput.Reset();
            OpenXrRuntime.Reset();
            XrHand.Reset();
            XRControllerWithRumble.Drop();
            Gamepad.current = null;
        }

        /// <summary>Puts a Touch controller into the right hand that supports waveforms, and parametric haptics from 60
        /// to 400 Hz.</summary>
        public static void TakeTouchController()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
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
