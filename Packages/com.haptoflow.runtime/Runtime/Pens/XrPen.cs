#nullable enable
using System;
using UnityEngine;
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using System.Collections.Generic;
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
    /// tracked.</summary>
    /// <remarks>Reads the Input System, as OpenXR needs, and pens of Meta's SDK by Logitech's action set.</remarks>
    [AddComponentMenu("HaptoFlow/XR Pen")]
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "xr-pen")]
    public sealed class XrPen : PressureTipForce
    {
        [SerializeField, Tooltip("The hand that holds the pen.")]
        private PenHand hand = PenHand.Right;

        [SerializeField, Tooltip("The stylus on a child of this object. It is inactive while nothing is tracked.")]
        private HapticStylus? stylus;

        private IPenDevice[] devices = Array.Empty<IPenDevice>();
        private bool isOpen;
        private bool isDevice;
        private float devicePressure = float.NaN;

        /// <summary>The stylus on a child of this object; null until one is set.</summary>
        public HapticStylus? Stylus
        {
            get => stylus;
            set
            {
                stylus = value;
                SetHandOfStylus();
            }
        }

        /// <summary>The hand that holds the pen.</summary>
        public PenHand Hand
        {
            get => hand;
            set
            {
                hand = value;
                SetHandOfStylus();
                if (isOpen)
                {
                    Close();
                    Open();
                }
            }
        }

        /// <inheritdoc/>
        public override HapticHand HeldIn => hand == PenHand.Left ? HapticHand.Left : HapticHand.Right;

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

        /// <inheritdoc/>
        protected override bool TryReadPressure(out float value)
        {
            if (isDevice)
            {
                value = devicePressure;
                return !float.IsNaN(devicePressure);
            }
            return TryReadControlPressure(out value);
        }

        private void OnEnable()
        {
            SetHandOfStylus();
            Open();
        }

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
            isDevice = TryReadDevice(out Vector3 position, out Quaternion rotation);
            bool held = isDevice || TryReadControls(out position, out rotation);
            if (held)
            {
                transform.localPosition = position;
                transform.localRotation = rotation;
            }
            SetStylusActive(held);
        }

        private bool TryReadDevice(out Vector3 position, out Quaternion rotation)
        {
            foreach (IPenDevice device in devices)
            {
                if (device.TryRead(out position, out rotation, out devicePressure))
                {
                    return true;
                }
            }
            position = default;
            rotation = Quaternion.identity;
            return false;
        }

        private void SetHandOfStylus()
        {
            if (stylus != null)
            {
                stylus.Hand = HeldIn;
            }
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
            devices = PenDevices.Open(hand);
            OpenControls();
        }

        private void Close()
        {
            isOpen = false;
            isDevice = false;
            devices = Array.Empty<IPenDevice>();
            CloseControls();
        }

#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
        // In this order of preference; the pen follows the first pose that its device has.
        private static readonly (string Position, string Rotation)[] Poses =
        {
            ("tipPose/position", "tipPose/rotation"),
            ("pointerPosition", "pointerRotation"),
            ("devicePosition", "deviceRotation"),
        };

        private readonly DisguisedMxInk disguise = new DisguisedMxInk();
        private readonly List<InputAction> opened = new List<InputAction>();
        private InputAction? isTracked;
        private InputAction? pressure;
        private InputAction? stick;
        private InputAction? stickTouched;
        private InputAction[] positions = Array.Empty<InputAction>();
        private InputAction[] rotations = Array.Empty<InputAction>();

        private bool TryReadControls(out Vector3 position, out Quaternion rotation)
        {
            int pose = Array.FindIndex(positions, action => action.controls.Count > 0);
            bool held = pose >= 0 && isTracked!.ReadValue<float>() > 0.5f;
            position = held ? positions[pose].ReadValue<Vector3>() : default;
            rotation = held ? rotations[pose].ReadValue<Quaternion>() : Quaternion.identity;
            if (held && pressure!.controls.Count == 0 && stickTouched!.controls.Count > 0)
            {
                disguise.Note(stick!.ReadValue<Vector2>(), stickTouched.ReadValue<float>() > 0.5f,
                    Time.realtimeSinceStartupAsDouble);
            }
            else
            {
                disguise.Forget();
            }
            return held;
        }

        private bool TryReadControlPressure(out float value)
        {
            bool has = pressure != null && pressure.controls.Count > 0;
            value = has ? pressure!.ReadValue<float>() : 0f;
            return has;
        }

        private void OpenControls()
        {
            isTracked = Enabled("isTracked");
            pressure = Enabled("tip");
            stick = Enabled("thumbstick");
            stickTouched = Enabled("thumbstickTouched");
            positions = Array.ConvertAll(Poses, pose => Enabled(pose.Position));
            rotations = Array.ConvertAll(Poses, pose => Enabled(pose.Rotation));
        }

        private void CloseControls()
        {
            opened.ForEach(action => action.Dispose());
            opened.Clear();
            pressure = null;
            positions = Array.Empty<InputAction>();
        }

        private InputAction Enabled(string control)
        {
            InputAction action = PenInput.Enabled("<XRController>{" + hand + "Hand}/" + control);
            opened.Add(action);
            return action;
        }
#else
        private bool TryReadControls(out Vector3 position, out Quaternion rotation)
        {
            position = default;
            rotation = Quaternion.identity;
            return false;
        }

        private bool TryReadControlPressure(out float value)
        {
            value = 0f;
            return false;
        }

        private void OpenControls()
        {
        }

        private void CloseControls()
        {
        }

        private void Start()
        {
            if (devices.Length == 0)
            {
                Debug.LogWarning("HaptoFlow: an XR Pen is inactive because this project does not use the Input System: " +
                    "install that package and choose it in Project Settings > Player > Active Input Handling.", this);
            }
        }
#endif
    }
}
