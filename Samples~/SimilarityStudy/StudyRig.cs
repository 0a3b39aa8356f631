#nullable enable
using UnityEngine;
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using UnityEngine.InputSystem;
using UnityEngine.InputSystem.XR;
#endif

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>The headset's tracking space with one pen: the other hand answers, and must feel nothing. Without a
    /// tracked pen there is one under the mouse, to try the study out.</summary>
    public sealed class StudyRig : MonoBehaviour
    {
        private XrPen tracked = null!;
        private MousePen mouse = null!;

        /// <summary>The tracked pen, else the mouse's.</summary>
        public HapticStylus Pen => IsTracked ? tracked.Stylus! : mouse.Stylus;

        private bool IsTracked => tracked.Stylus != null && tracked.Stylus.gameObject.activeInHierarchy;

        /// <summary>The space with its pen.</summary>
        public static StudyRig Create(Camera view, PenHand hand)
        {
            var rig = new GameObject("XR Rig").AddComponent<StudyRig>();
            rig.tracked = XrPen.Create(rig.transform, hand);
            rig.mouse = MousePen.Create(view);
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
            rig.Follow(view);
#endif
            return rig;
        }

        private void Update()
        {
            // Both at once would both be felt.
            bool wantsMouse = !IsTracked;
            if (wantsMouse != mouse.gameObject.activeSelf)
            {
                mouse.gameObject.SetActive(wantsMouse);
            }
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
            PlaceOnce();
#endif
        }

#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
        private InputAction isTracked = null!;
        private InputAction position = null!;
        private InputAction rotation = null!;
        private Camera view = null!;
        private bool placed;

        private void Follow(Camera eye)
        {
            view = eye;
            isTracked = Enabled("<XRHMD>/isTracked");
            position = Enabled("<XRHMD>/centerEyePosition");
            rotation = Enabled("<XRHMD>/centerEyeRotation");
        }

        private static InputAction Enabled(string binding)
        {
            var action = new InputAction(binding: binding);
            action.Enable();
            return action;
        }

        /// <summary>Once the head is tracked, the eyes are put where the scene has its camera.</summary>
        private void PlaceOnce()
        {
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

        private static float YawDegrees(Quaternion turned)
        {
            Vector3 forward = turned * Vector3.forward;
            return (float)(System.Math.Atan2(forward.x, forward.z) * 180.0 / System.Math.PI);
        }

        private void OnDestroy()
        {
            isTracked.Dispose();
            position.Dispose();
            rotation.Dispose();
        }
#endif
    }
}
