#nullable enable
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using System;
using System.Linq;
using UnityEngine;
using UnityEngine.InputSystem;

namespace HaptoFlow.Samples.StylusTracing
{
    /// <summary>A stylus on what one hand holds: MX Ink by its tip, with the force that the tip measures; a controller
    /// by where it points, with the spring model. Asleep while nothing is tracked.</summary>
    public sealed class XrPen : MonoBehaviour
    {
        // What the device has of these, the first counts: MX Ink's tip, a controller's front, a controller's grip.
        private static readonly (string Position, string Rotation)[] Poses =
        {
            ("tipPose/position", "tipPose/rotation"),
            ("pointerPosition", "pointerRotation"),
            ("devicePosition", "deviceRotation"),
        };

        private InputAction isTracked = null!;
        private InputAction pressure = null!;
        private InputAction[] positions = null!;
        private InputAction[] rotations = null!;
        private HapticStylus stylus = null!;

        /// <summary>What feels.</summary>
        public HapticStylus Stylus => stylus;

        /// <param name="space">Tracking space.</param>
        /// <param name="hand">"LeftHand" or "RightHand".</param>
        public static XrPen Create(Transform space, string hand)
        {
            var owner = new GameObject("Pen " + hand);
            owner.transform.SetParent(space, false);
            var pen = owner.AddComponent<XrPen>();
            pen.isTracked = Enabled(hand, "isTracked");
            pen.positions = Poses.Select(pose => Enabled(hand, pose.Position)).ToArray();
            pen.rotations = Poses.Select(pose => Enabled(hand, pose.Rotation)).ToArray();
            pen.pressure = Action(hand, "tip");

            var tip = new GameObject("Tip");
            tip.SetActive(false);
            tip.transform.SetParent(owner.transform, false);
            var force = tip.AddComponent<InputActionTipForce>();
            force.Pressure = new InputActionProperty(pen.pressure);
            pen.stylus = tip.AddComponent<HapticStylus>();
            pen.stylus.Force = force;
            Build.PenBody(tip.transform, new Color(0.9f, 0.9f, 0.92f));
            // A pen's body goes backwards from its tip.
            tip.transform.localRotation = Quaternion.AngleAxis(-90f, Vector3.right);
            return pen;
        }

        private static InputAction Action(string hand, string control) =>
            new InputAction(binding: "<XRController>{" + hand + "}/" + control);

        private static InputAction Enabled(string hand, string control)
        {
            InputAction action = Action(hand, control);
            action.Enable();
            return action;
        }

        private void Update()
        {
            int pose = Array.FindIndex(positions, action => action.controls.Count > 0);
            bool held = pose >= 0 && isTracked.ReadValue<float>() > 0.5f;
            if (held)
            {
                transform.localPosition = positions[pose].ReadValue<Vector3>();
                transform.localRotation = rotations[pose].ReadValue<Quaternion>();
            }
            if (held != stylus.gameObject.activeSelf)
            {
                stylus.gameObject.SetActive(held);
            }
        }

        private void OnDestroy()
        {
            isTracked.Dispose();
            pressure.Dispose();
            foreach (InputAction action in positions.Concat(rotations))
            {
                action.Dispose();
            }
        }
    }
}
#endif
