#nullable enable
using System;
using UnityEngine;
using UnityEngine.InputSystem;

namespace HaptoFlow
{
    /// <summary>Tip force from an action of the Input System. For MX Ink through OpenXR: enable its interaction profile
    /// and bind the action to tip_logitech/force.</summary>
    [AddComponentMenu("HaptoFlow/Tip Force (Input Action)")]
    [HelpPage(HelpPages.Components + "tip-force-input-action")]
    public sealed class InputActionTipForce : PressureTipForce
    {
        [SerializeField, Tooltip("The value action of type Axis that reports the pressure, 0 to 1.")]
        private InputActionProperty pressure;

        /// <summary>A value action of type Axis, 0 to 1. Set it before the component is enabled, or while it is
        /// disabled.</summary>
        public InputActionProperty Pressure { get => pressure; set => pressure = value; }

        /// <summary>The hand that the action's bindings name, as in &lt;XRController&gt;{RightHand}/tip; None where they
        /// name none or both.</summary>
        public override HapticHand HeldIn
        {
            get
            {
                bool left = false;
                bool right = false;
                InputAction? action = pressure.action;
                for (int index = 0; action != null && index < action.bindings.Count; ++index)
                {
                    string path = action.bindings[index].effectivePath ?? "";
                    left |= path.IndexOf("{LeftHand}", StringComparison.OrdinalIgnoreCase) >= 0;
                    right |= path.IndexOf("{RightHand}", StringComparison.OrdinalIgnoreCase) >= 0;
                }
                return left == right ? HapticHand.None : left ? HapticHand.Left : HapticHand.Right;
            }
        }

        /// <inheritdoc/>
        protected override bool TryReadPressure(out float value)
        {
            InputAction? action = pressure.action;
            // An action without a bound control always reads 0, which must not count as a pen in the air.
            bool hasDevice = action != null && action.controls.Count > 0;
            value = hasDevice ? action!.ReadValue<float>() : 0f;
            return hasDevice;
        }

        // Enable only an action of the component's own; an action of an asset may be shared.
        private void OnEnable()
        {
            if (pressure.reference == null)
            {
                pressure.action?.Enable();
            }
        }

        private void OnDisable()
        {
            if (pressure.reference == null)
            {
                pressure.action?.Disable();
            }
        }
    }
}
