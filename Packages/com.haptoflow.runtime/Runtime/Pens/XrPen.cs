#nullable enable
using UnityEngine;
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using System;
using UnityEngine.InputSystem;
#endif

namespace HaptoFlow
{
    /// <summary>Which hand holds a pen.</summary>
    public enum PenHand
    {
        /// <summary>The right one.</summary>
        Right,

        /// <summary>The left one.</summary>
        Left,
    }

    /// <summary>A stylus on what one hand holds: MX Ink by its tip, with the force that the tip measures; a controller
    /// by where it points, with the spring model. Belongs below the rig's tracking space; its stylus sleeps while
    /// nothing is tracked. Needs the Input System, as OpenXR itself.</summary>
    [AddComponentMenu("HaptoFlow/XR Pen")]
    [DisallowMultipleComponent]
    [HelpURL(HelpPages.Components + "xr-pen")]
    public sealed class XrPen : PressureTipForce
    {
        [SerializeField, Tooltip("Which hand holds it.")]
        private PenHand hand = PenHand.Right;

        [SerializeField, Tooltip("The stylus on a child of this object: it is switched off while nothing is tracked.")]
        private HapticStylus? stylus;

        /// <summary>The stylus on a child of this object: what feels. Null until one is set.</summary>
        public HapticStylus? Stylus
        {
            get => stylus;
            set => stylus = value;
        }

        /// <summary>A pen with stylus and body. Main thread, also while a scene is edited.</summary>
        /// <param name="space">Tracking space; null for the world.</param>
        public static XrPen Create(Transform? space, PenHand hand)
        {
            var owner = new GameObject("XR Pen " + hand);
            // Asleep until it is whole.
            owner.SetActive(false);
            owner.transform.SetParent(space, false);
            var pen = owner.AddComponent<XrPen>();
            pen.hand = hand;
            var tip = new GameObject("Tip");
            tip.transform.SetParent(owner.transform, false);
            // A pen's body goes backwards from its tip.
            tip.transform.localRotation = Quaternion.AngleAxis(-90f, Vector3.right);
            pen.stylus = tip.AddComponent<HapticStylus>();
            pen.stylus.Tip = tip.transform;
            pen.stylus.Force = pen;
            PenBody.Add(tip.transform, new Color(0.9f, 0.9f, 0.92f));
            owner.SetActive(true);
            return pen;
        }

#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
        // What the device has of these, the first counts: MX Ink's tip, a controller's front, a controller's grip.
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

        /// <summary>Which hand holds it.</summary>
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
            // Unity refuses to switch a child off while it switches off the parent: then the stylus rests anyway.
            if (gameObject.activeInHierarchy)
            {
                Wake(false);
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
            Wake(held);
        }

        private void Wake(bool held)
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
        /// <summary>Which hand holds it.</summary>
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
            Debug.LogWarning("HaptoFlow: an XR Pen sleeps, since this project does not use the Input System: install " +
                "that package and choose it in Project Settings > Player > Active Input Handling.", this);
        }
#endif
    }
}
