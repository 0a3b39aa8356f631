#nullable enable
using UnityEngine;
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using System;
using UnityEngine.InputSystem;
#endif

namespace HaptoFlow
{
    /// <summary>The hand that holds a pen.</summary>
    public enum PenHand
    {
        /// <summary>The right hand.</summary>
        Right,

        /// <summary>The left hand.</summary>
        Left,
    }

    /// <summary>A stylus on the device in one hand: MX Ink at its tip with the measured force, a controller at its
    /// pointer with the spring model. Place it below the rig's tracking space. Its stylus is inactive while nothing is
    /// tracked. Requires the Input System, like OpenXR itself.</summary>
    [AddComponentMenu("HaptoFlow/XR Pen")]
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "xr-pen")]
    public sealed class XrPen : PressureTipForce
    {
        [SerializeField, Tooltip("The hand that holds the pen.")]
        private PenHand hand = PenHand.Right;

        [SerializeField, Tooltip("The stylus on a child of this object. It is inactive while nothing is tracked.")]
        private HapticStylus? stylus;

        /// <summary>The stylus on a child of this object; null until one is set.</summary>
        public HapticStylus? Stylus
        {
            get => stylus;
            set => stylus = value;
        }

        /// <summary>Creates a pen with stylus and body. Main thread, also in edit mode.</summary>
        /// <param name="space">The tracking space; null for the world.</param>
        public static XrPen Create(Transform? space, PenHand hand)
        {
            var owner = new GameObject("XR Pen " + hand);
            // Inactive until it is complete.
            owner.SetActive(false);
            owner.transform.SetParent(space, false);
            var pen = owner.AddComponent<XrPen>();
            pen.hand = hand;
            var tip = new GameObject("Tip");
            tip.transform.SetParent(owner.transform, false);
            // The body of the pen extends backwards from its tip.
            tip.transform.localRotation = Quaternion.AngleAxis(-90f, Vector3.right);
            pen.stylus = tip.AddComponent<HapticStylus>();
            pen.stylus.Tip = tip.transform;
            pen.stylus.Force = pen;
            PenBody.Add(tip.transform, new Color(0.9f, 0.9f, 0.92f));
            owner.SetActive(true);
            return pen;
        }

#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
        // The first pose that the device has is used: MX Ink's tip, a controller's pointer, a controller's grip.
        private static readonly (string Position, string Rotation)[] Poses =
        {
            ("tipPose/position", "tipPose/rotation"),
            ("pointerPosition", "pointerRotation"),
            ("devicePosition", "deviceRotation"),
        };

        private InputAction? isTracked;
        private InputAction? pressure;
        private InputAction[] positions = Array.Empty<InputAction>();
        private InputAction[] rotations = Array.Empty<InputAction>();
        private bool isOpen;

        /// <summary>The hand that holds the pen.</summary>
        public PenHand Hand
        {
            get => hand;
            set
            {
                hand = value;
                if (isOpen)
                {
                    Close();
                    Open();
                }
            }
        }

        /// <inheritdoc/>
        protected override bool TryReadPressure(out float value)
        {
            bool has = pressure != null && pressure.controls.Count > 0;
            value = has ? pressure!.ReadValue<float>() : 0f;
            return has;
        }

        private void OnEnable() => Open();

        private void OnDisable()
        {
            // Unity does not allow deactivating a child while its parent is being deactivated; the stylus is then
            // inactive anyway.
            if (gameObject.activeInHierarchy)
            {
                SetStylusActive(false);
            }
            Close();
        }

        private void Update()
        {
            int pose = Array.FindIndex(positions, action => action.controls.Count > 0);
            bool held = pose >= 0 && isTracked!.ReadValue<float>() > 0.5f;
            if (held)
            {
                transform.localPosition = positions[pose].ReadValue<Vector3>();
                transform.localRotation = rotations[pose].ReadValue<Quaternion>();
            }
            SetStylusActive(held);
        }

        private void SetStylusActive(bool held)
        {
            if (stylus != null && stylus.gameObject != gameObject && held != stylus.gameObject.activeSelf)
            {
                stylus.gameObject.SetActive(held);
            }
        }

        private void Open()
        {
            isOpen = true;
            if (stylus != null)
            {
                stylus.Hand = hand == PenHand.Left ? HapticHand.Left : HapticHand.Right;
            }
            isTracked = Enabled("isTracked");
            pressure = Enabled("tip");
            positions = Array.ConvertAll(Poses, pose => Enabled(pose.Position));
            rotations = Array.ConvertAll(Poses, pose => Enabled(pose.Rotation));
        }

        private void Close()
        {
            isOpen = false;
            isTracked?.Dispose();
            pressure?.Dispose();
            Array.ForEach(positions, action => action.Dispose());
            Array.ForEach(rotations, action => action.Dispose());
            isTracked = null;
            pressure = null;
            positions = Array.Empty<InputAction>();
            rotations = Array.Empty<InputAction>();
        }

        private InputAction Enabled(string control)
        {
            var action = new InputAction(binding: "<XRController>{" + hand + "Hand}/" + control);
            action.Enable();
            return action;
        }
#else
        /// <summary>The hand that holds the pen.</summary>
        public PenHand Hand
        {
            get => hand;
            set => hand = value;
        }

        /// <inheritdoc/>
        protected override bool TryReadPressure(out float value)
        {
            value = 0f;
            return false;
        }

        private void Start()
        {
            if (stylus != null && stylus.gameObject != gameObject)
            {
                stylus.gameObject.SetActive(false);
            }
            Debug.LogWarning("HaptoFlow: an XR Pen is inactive because this project does not use the Input System: " +
                "install that package and choose it in Project Settings > Player > Active Input Handling.", this);
        }
#endif
    }
}
