#nullable enable
using UnityEngine;
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using UnityEngine.InputSystem;
#endif

namespace HaptoFlow
{
    /// <summary>Position and pressure of the mouse or a graphics pen, from the input backend of the project. Main
    /// thread.</summary>
    internal static class PenInput
    {
        /// <param name="pixels">Position relative to the lower left corner of the game view.</param>
        /// <param name="pressure">Pressure, 0 in the air to 1.</param>
        /// <returns>False where there is neither mouse nor pen.</returns>
        public static bool TryRead(out Vector2 pixels, out float pressure)
        {
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
            Pen? pen = Pen.current;
            if (pen != null && pen.tip.isPressed)
            {
                pixels = pen.position.ReadValue();
                pressure = pen.pressure.ReadValue();
                return true;
            }
            Mouse? mouse = Mouse.current;
            pixels = mouse != null ? mouse.position.ReadValue() : default;
            pressure = mouse != null && mouse.leftButton.isPressed ? 1f : 0f;
            return mouse != null;
#elif ENABLE_LEGACY_INPUT_MANAGER
            Vector3 place = Input.mousePosition;
            pixels = new Vector2(place.x, place.y);
            pressure = Input.GetMouseButton(0) ? 1f : 0f;
            return true;
#else
            pixels = default;
            pressure = 0f;
            return false;
#endif
        }
    }
}
