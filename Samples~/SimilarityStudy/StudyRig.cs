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
        private bool wasTracked;

        /// <summary>The tracked pen, also while it is out of sight; the mouse's as long as none was ever tracked.
        /// </summary>
        public HapticStylus Pen => wasTracked ? tracked.Stylus! : mouse.Stylus;

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

        /// <summary>Where both pens are felt.</summary>
        public void PlayOn(HapticOutput output)
        {
            tracked.Stylus!.Output = output;
            mouse.Stylus.Output = output;
        }

        // A pen that is not tracked has gone to sleep by now.
        private void LateUpdate()
        {
            if (!wasTracked && tracked.Stylus!.gameObject.activeInHierarchy)
            {
                wasTracked = true;
                // Both at once would both be felt.
                mouse.gameObject.SetActive(false);
            }
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

        // Once the head is tracked, the eyes are put where the scene has its camera.
        private void Update()
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
