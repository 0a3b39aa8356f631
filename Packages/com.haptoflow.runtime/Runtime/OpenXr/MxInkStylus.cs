#nullable enable
using UnityEngine.InputSystem.Controls;
using UnityEngine.InputSystem.Layouts;
using UnityEngine.InputSystem.XR;
using UnityEngine.Scripting;
using UnityEngine.XR.OpenXR.Input;
#if USE_INPUT_SYSTEM_POSE_CONTROL && HAPTOFLOW_INPUT_SYSTEM_1_4
using PoseControl = UnityEngine.InputSystem.XR.PoseControl;
#else
using PoseControl = UnityEngine.XR.OpenXR.Input.PoseControl;
#endif

namespace HaptoFlow
{
    /// <summary>An MX Ink in the Input System, by the profile <see cref="MxInkInteraction"/>. Controls are named as in
    /// the profiles of other packages, so that bindings fit all of them.</summary>
    /// <remarks>Unity's plug-in reports an action as the control of its name. From <see cref="isTracked"/> on, controls
    /// repeat parts of the first two poses, as every controller has them: they read the same bytes, whose offsets follow
    /// from the order of actions in <see cref="MxInkInteraction"/> and from the 60 bytes of a pose.</remarks>
    [Preserve]
    [InputControlLayout(displayName = MxInkInteraction.DisplayName, commonUsages = new[] { "LeftHand", "RightHand" })]
    public sealed class MxInkStylus : XRControllerWithRumble
    {
        /// <summary>The pose of a hand that holds the pen in its fist.</summary>
        [Preserve, InputControl(offset = 0, aliases = new[] { "device", "gripPose" }, usage = "Device")]
        public PoseControl devicePose { get; private set; } = null!;

        /// <summary>The pose of a ray for pointing at distant things.</summary>
        [Preserve, InputControl(offset = 0, alias = "aimPose", usage = "Pointer")]
        public PoseControl pointer { get; private set; } = null!;

        /// <summary>The pose of the tip: its sharpest point, with z along the pen towards what it writes on.</summary>
        [Preserve, InputControl(offset = 0, usage = "TipPose")]
        public PoseControl tipPose { get; private set; } = null!;

        /// <summary>The force on the tip, from 0 to 1.</summary>
        [Preserve, InputControl(usage = "Tip")]
        public AxisControl tip { get; private set; } = null!;

        /// <summary>The force on the middle button, from 0 to 1.</summary>
        [Preserve, InputControl(usage = "Trigger")]
        public AxisControl clusterMiddleButton { get; private set; } = null!;

        /// <summary>The button nearest to the tip.</summary>
        [Preserve, InputControl(usage = "GripButton")]
        public ButtonControl clusterFrontButton { get; private set; } = null!;

        /// <summary>Two taps on the front button.</summary>
        [Preserve, InputControl]
        public ButtonControl clusterFrontDoubleTap { get; private set; } = null!;

        /// <summary>The button farthest from the tip.</summary>
        [Preserve, InputControl(usage = "PrimaryButton")]
        public ButtonControl clusterBackButton { get; private set; } = null!;

        /// <summary>Two taps on the back button.</summary>
        [Preserve, InputControl(usage = "SecondaryButton")]
        public ButtonControl clusterBackDoubleTap { get; private set; } = null!;

        /// <summary>The button at the rear end, which headsets may keep for themselves.</summary>
        [Preserve, InputControl(usage = "MenuButton")]
        public ButtonControl systemButton { get; private set; } = null!;

        /// <summary>Becomes true when the pen is put into its dock, immediately before its tracking ends.</summary>
        [Preserve, InputControl]
        public ButtonControl docked { get; private set; } = null!;

        /// <summary>The vibration motor.</summary>
        [Preserve, InputControl(usage = "Haptic")]
        public HapticControl haptic { get; private set; } = null!;

        /// <summary>Whether <see cref="devicePose"/> is tracked.</summary>
        [Preserve, InputControl(offset = 0, usage = "IsTracked")]
        public new ButtonControl isTracked { get; private set; } = null!;

        /// <summary>Which parts of <see cref="devicePose"/> are valid.</summary>
        [Preserve, InputControl(offset = 4, usage = "TrackingState")]
        public new IntegerControl trackingState { get; private set; } = null!;

        /// <summary>The position of <see cref="devicePose"/>, in m.</summary>
        [Preserve, InputControl(offset = 8, noisy = true, alias = "gripPosition")]
        public new Vector3Control devicePosition { get; private set; } = null!;

        /// <summary>The rotation of <see cref="devicePose"/>.</summary>
        [Preserve, InputControl(offset = 20, noisy = true, alias = "gripOrientation")]
        public new QuaternionControl deviceRotation { get; private set; } = null!;

        /// <summary>The position of <see cref="pointer"/>, in m.</summary>
        [Preserve, InputControl(offset = 68, noisy = true)]
        public Vector3Control pointerPosition { get; private set; } = null!;

        /// <summary>The rotation of <see cref="pointer"/>.</summary>
        [Preserve, InputControl(offset = 80, noisy = true, alias = "pointerOrientation")]
        public QuaternionControl pointerRotation { get; private set; } = null!;

        /// <inheritdoc/>
        protected override void FinishSetup()
        {
            base.FinishSetup();
            devicePose = GetChildControl<PoseControl>(nameof(devicePose));
            pointer = GetChildControl<PoseControl>(nameof(pointer));
            tipPose = GetChildControl<PoseControl>(nameof(tipPose));
            tip = GetChildControl<AxisControl>(nameof(tip));
            clusterMiddleButton = GetChildControl<AxisControl>(nameof(clusterMiddleButton));
            clusterFrontButton = GetChildControl<ButtonControl>(nameof(clusterFrontButton));
            clusterFrontDoubleTap = GetChildControl<ButtonControl>(nameof(clusterFrontDoubleTap));
            clusterBackButton = GetChildControl<ButtonControl>(nameof(clusterBackButton));
            clusterBackDoubleTap = GetChildControl<ButtonControl>(nameof(clusterBackDoubleTap));
            systemButton = GetChildControl<ButtonControl>(nameof(systemButton));
            docked = GetChildControl<ButtonControl>(nameof(docked));
            haptic = GetChildControl<HapticControl>(nameof(haptic));
            isTracked = GetChildControl<ButtonControl>(nameof(isTracked));
            trackingState = GetChildControl<IntegerControl>(nameof(trackingState));
            devicePosition = GetChildControl<Vector3Control>(nameof(devicePosition));
            deviceRotation = GetChildControl<QuaternionControl>(nameof(deviceRotation));
            pointerPosition = GetChildControl<Vector3Control>(nameof(pointerPosition));
            pointerRotation = GetChildControl<QuaternionControl>(nameof(pointerRotation));
        }
    }
}
