#nullable enable
using UnityEngine;
using UnityEngine.InputSystem;

namespace HaptoFlow
{
    /// <summary>Tip force from an action of the Input System. For MX Ink through OpenXR: its interaction profile, and a
    /// binding to tip_logitech/force.</summary>
    [AddComponentMenu("HaptoFlow/Tip Force (Input Action)")]
    [HelpURL(HelpPages.Components + "tip-force-input-action")]
    public sealed class InputActionTipForce : PressureTipForce
    {
        [SerializeField, Tooltip("A value action of type Axis, 0 to 1.")]
        private InputActionProperty pressure;

        /// <summary>A value action of type Axis, 0 to 1. To be set before the component wakes, or while it is off.
        /// </summary>
        public InputActionProperty Pressure
        {
            get => pressure;
            set => pressure = value;
        }

        /// <inheritdoc/>
        protected override bool TryReadPressure(out float value)
        {
            InputAction? action = pressure.action;
            // Without a control that it is bound to, an action reads 0 for ever: that is no pen in the air.
            bool hasDevice = action != null && action.controls.Count > 0;
            value = hasDevice ? action!.ReadValue<float>() : 0f;
            return hasDevice;
        }

        // An action of the component's own is nobody else's to enable; one of an asset may be shared.
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
