#nullable enable
using System.Collections.Generic;
using UnityEngine;
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM && HAPTOFLOW_XR && ENABLE_VR
using System;
using UnityEngine.InputSystem;
using UnityEngine.InputSystem.XR;
#endif

namespace HaptoFlow
{
    /// <summary>The tracking space of a headset. When the head is tracked for the first time, the space moves so that
    /// the participant looks from where the scene has its camera, and the camera follows the head from then on. Without
    /// a headset the camera stays where it is.</summary>
    /// <remarks>Runs after <see cref="XrPen"/>, so that it knows in each frame which pens are tracked. Needs the Input
    /// System.</remarks>
    [AddComponentMenu("HaptoFlow/XR Rig")]
    [DefaultExecutionOrder(100)]
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "xr-rig")]
    public sealed class XrRig : MonoBehaviour
    {
        [SerializeField, Tooltip("The camera that follows the head. When it is empty, the scene's main camera is " +
            "used.")]
        private Camera? view;

        [SerializeField, Tooltip("The mouse pen is switched off when an XR Pen below this object is tracked for the " +
            "first time. When it is empty, no mouse pen is switched off.")]
        private MousePen? mousePen;

        private readonly List<XrPen> pens = new List<XrPen>();
        private XrPen? trackedPen;

        /// <summary>The camera that follows the head; null for the scene's main camera. Set it before the head is
        /// tracked.</summary>
        public Camera? View { get => view; set => view = value; }

        /// <summary>The mouse pen that is switched off when an XR Pen of this rig is tracked for the first time; null
        /// to leave mouse pens alone.</summary>
        public MousePen? MousePen { get => mousePen; set => mousePen = value; }

        /// <summary>The stylus of the first XR Pen that was tracked, even while it is out of sight. Before any was
        /// tracked, the stylus of <see cref="MousePen"/>; null without one.</summary>
        public HapticStylus? PenInUse =>
            trackedPen != null ? trackedPen.Stylus : mousePen != null ? mousePen.Stylus : null;

        /// <summary>Creates a rig without pens. Main thread.</summary>
        /// <param name="view">The camera that follows the head; null for the scene's main camera.</param>
        public static XrRig Create(Camera? view)
        {
            var rig = new GameObject("XR Rig").AddComponent<XrRig>();
            rig.view = view;
            return rig;
        }

        /// <summary>Adds a pen in one hand. Main thread.</summary>
        public XrPen AddPen(PenHand hand)
        {
            XrPen pen = XrPen.Create(transform, hand);
            pens.Add(pen);
            return pen;
        }

        private void Start() => GetComponentsInChildren(true, pens);

        private void Update()
        {
            FindTrackedPen();
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM && HAPTOFLOW_XR && ENABLE_VR
            FollowHead();
#endif
        }

        private void FindTrackedPen()
        {
            for (int index = 0; trackedPen == null && index < pens.Count; ++index)
            {
                // An XR Pen deactivates its stylus while it is not tracked.
                HapticStylus? stylus = pens[index].Stylus;
                if (stylus == null || !stylus.gameObject.activeInHierarchy)
                {
                    continue;
                }
                trackedPen = pens[index];
                if (mousePen != null)
                {
                    // Both pens at once would both be felt.
                    mousePen.gameObject.SetActive(false);
                }
            }
        }

#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM && HAPTOFLOW_XR && ENABLE_VR
        private InputAction? isTracked;
        private InputAction? position;
        private InputAction? rotation;
        private bool isPlaced;

        private void Awake()
        {
            isTracked = PenInput.Enabled("<XRHMD>/isTracked");
            position = PenInput.Enabled("<XRHMD>/centerEyePosition");
            rotation = PenInput.Enabled("<XRHMD>/centerEyeRotation");
        }

        private void OnDestroy()
        {
            isTracked?.Dispose();
            position?.Dispose();
            rotation?.Dispose();
        }

        private void FollowHead()
        {
            if (isPlaced || isTracked!.ReadValue<float>() < 0.5f)
            {
                return;
            }
            Camera? camera = view != null ? view : Camera.main;
            if (camera == null)
            {
                return;
            }
            isPlaced = true;
            float wantedYaw = YawDegrees(camera.transform.rotation);
            float headYaw = YawDegrees(rotation!.ReadValue<Quaternion>());
            transform.rotation = Quaternion.AngleAxis(wantedYaw - headYaw, Vector3.up);
            transform.position = camera.transform.position -
                transform.rotation * Vector3.Scale(transform.lossyScale, position!.ReadValue<Vector3>());
            camera.transform.SetParent(transform, false);
            var driver = camera.gameObject.AddComponent<TrackedPoseDriver>();
#if HAPTOFLOW_INPUT_SYSTEM_1_1
            driver.positionInput = new InputActionProperty(position);
            driver.rotationInput = new InputActionProperty(rotation);
#else
            driver.positionAction = position;
            driver.rotationAction = rotation;
#endif
        }

        private static float YawDegrees(Quaternion rotation)
        {
            Vector3 forward = rotation * Vector3.forward;
            return (float)(Math.Atan2(forward.x, forward.z) * 180.0 / Math.PI);
        }
#endif
    }
}
