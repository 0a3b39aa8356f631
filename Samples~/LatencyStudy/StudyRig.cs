#nullable enable
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using System;
using UnityEngine;
using UnityEngine.InputSystem;
using UnityEngine.InputSystem.XR;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>A headset's tracking space with a pen in one hand. Once the head is tracked, the space is placed so
    /// that the eyes are where the scene has its camera; without a headset the camera stays.</summary>
    [DefaultExecutionOrder(100)]
    public sealed class StudyRig : MonoBehaviour
    {
        private InputAction isTracked = null!;
        private InputAction position = null!;
        private InputAction rotation = null!;
        private Camera view = null!;
        private bool placed;

        /// <summary>The pen.</summary>
        public XrPen Pen { get; private set; } = null!;

        /// <summary>Goes when the pen in the hand is tracked for the first time: the mouse's pen, which would stand in
        /// the participant's view. Null for nothing.</summary>
        public GameObject? WithoutHeadset { get; set; }

        /// <summary>The space with a pen in one hand.</summary>
        public static StudyRig Create(Camera view, PenHand hand)
        {
            var rig = new GameObject("XR Rig").AddComponent<StudyRig>();
            rig.view = view;
            rig.isTracked = Enabled("<XRHMD>/isTracked");
            rig.position = Enabled("<XRHMD>/centerEyePosition");
            rig.rotation = Enabled("<XRHMD>/centerEyeRotation");
            rig.Pen = XrPen.Create(rig.transform, hand);
            return rig;
        }

        private static InputAction Enabled(string binding)
        {
            var action = new InputAction(binding: binding);
            action.Enable();
            return action;
        }

        private void Update()
        {
            // The pen has looked for its device in this frame already: it comes earlier.
            if (WithoutHeadset != null && Pen.Stylus!.gameObject.activeSelf)
            {
                WithoutHeadset.SetActive(false);
            }
            if (placed || isTracked.ReadValue<float>() < 0.5f)
            {
                return;
            }
            placed = true;
            float wanted = YawDegrees(view.transform.rotation);
            float actual = YawDegrees(rotation.ReadValue<Quaternion>());
            transform.rotation = Quaternion.AngleAxis(wanted - actual, Vector3.up);
            transform.position = view.transform.position - transform.rotation * position.ReadValue<Vector3>();
            view.transform.SetParent(transform, false);
            var driver = view.gameObject.AddComponent<TrackedPoseDriver>();
            driver.positionInput = new InputActionProperty(position);
            driver.rotationInput = new InputActionProperty(rotation);
        }

        private void OnDestroy()
        {
            isTracked.Dispose();
            position.Dispose();
            rotation.Dispose();
        }

        private static float YawDegrees(Quaternion turned)
        {
            Vector3 forward = turned * Vector3.forward;
            return (float)(Math.Atan2(forward.x, forward.z) * 180.0 / Math.PI);
        }
    }
}
#endif
