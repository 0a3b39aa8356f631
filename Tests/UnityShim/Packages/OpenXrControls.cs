using UnityEngine.InputSystem;
using UnityEngine.InputSystem.Controls;
using UnityEngine.InputSystem.Layouts;

namespace UnityEngine.XR.OpenXR.Input
{
    public struct Haptic
    {
    }

    public class HapticControl : InputControl<Haptic>
    {
        public HapticControl()
            : base(null)
        {
        }
    }

    public struct Pose
    {
    }

    public class PoseControl : InputControl<Pose>
    {
        public PoseControl()
            : base(null)
        {
        }

        [InputControl(offset = 0)]
        public ButtonControl isTracked { get; private set; } = null!;

        [InputControl(offset = 4)]
        public IntegerControl trackingState { get; private set; } = null!;

        [InputControl(offset = 8, noisy = true)]
        public Vector3Control position { get; private set; } = null!;

        [InputControl(offset = 20, noisy = true)]
        public QuaternionControl rotation { get; private set; } = null!;

        [InputControl(offset = 36, noisy = true)]
        public Vector3Control velocity { get; private set; } = null!;

        [InputControl(offset = 48, noisy = true)]
        public Vector3Control angularVelocity { get; private set; } = null!;
    }
}
