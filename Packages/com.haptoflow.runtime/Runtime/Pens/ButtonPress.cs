#nullable enable
using System;
using UnityEngine;
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using UnityEngine.InputSystem;
#endif

namespace HaptoFlow
{
    /// <summary>Detects that one of several buttons with the same function goes down. Without the Input System, only
    /// keys do, by the old Input Manager. Main thread.</summary>
    /// <remarks>InputAction.WasPressedThisFrame would do the same, but the Input System has it only from version 1.1,
    /// and this package accepts 1.0.</remarks>
    public sealed class ButtonPress : IDisposable
    {
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
        private readonly InputAction[] actions;
        private bool wasDown;

        /// <summary>Enables the buttons.</summary>
        /// <param name="bindings">Control paths of the Input System, for example "&lt;Keyboard&gt;/y".</param>
        public ButtonPress(params string[] bindings) => actions = Array.ConvertAll(bindings, PenInput.Enabled);

        /// <summary>True in the frame in which a button goes down while none was held. Call it once a frame.</summary>
        public bool IsNew()
        {
            bool isDown = false;
            foreach (InputAction action in actions)
            {
                isDown |= action.ReadValue<float>() > 0.5f;
            }
            bool isNew = isDown && !wasDown;
            wasDown = isDown;
            return isNew;
        }

        /// <summary>Disables and releases the buttons.</summary>
        public void Dispose() => Array.ForEach(actions, action => action.Dispose());
#else
        private const string Keyboard = "<Keyboard>/";
        private readonly KeyCode[] keys;

        /// <summary>Finds the keys among the buttons.</summary>
        /// <param name="bindings">Control paths of the Input System, for example "&lt;Keyboard&gt;/y".</param>
        public ButtonPress(params string[] bindings) => keys = Array.ConvertAll(
            Array.FindAll(bindings, path => path.StartsWith(Keyboard, StringComparison.Ordinal)),
            path => KeyOf(path.Substring(Keyboard.Length)));

        /// <summary>True in the frame in which a key goes down. Call it once a frame.</summary>
#if ENABLE_LEGACY_INPUT_MANAGER
        public bool IsNew() => Array.Exists(keys, Input.GetKeyDown);
#else
        public bool IsNew() => false;
#endif

        /// <summary>Does nothing without the Input System.</summary>
        public void Dispose()
        {
        }

        private static KeyCode KeyOf(string name) => name switch
        {
            "enter" => KeyCode.Return,
            _ when char.IsDigit(name[0]) => KeyCode.Alpha0 + (name[0] - '0'),
            _ => (KeyCode)Enum.Parse(typeof(KeyCode), name, true),
        };
#endif

        /// <summary>The path of the controller in the hand without the pen, with a slash at its end.</summary>
        public static string ControllerOppositeTo(PenHand penHand) =>
            "<XRController>{" + (penHand == PenHand.Right ? PenHand.Left : PenHand.Right) + "Hand}/";

        /// <summary>The answer of this frame; null without one, or with both at once. Call it once a frame.</summary>
        public static bool? Answer(ButtonPress yes, ButtonPress no)
        {
            bool isYes = yes.IsNew();
            bool isNo = no.IsNew();
            return isYes == isNo ? (bool?)null : isYes;
        }
    }

    /// <summary>Position and pressure of the mouse or a graphics pen, from the input backend of the project. Main
    /// thread.</summary>
    internal static class PenInput
    {
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
        /// <summary>An enabled action of one control, which the caller disposes.</summary>
        public static InputAction Enabled(string binding)
        {
            var action = new InputAction(binding: binding);
            action.Enable();
            return action;
        }
#endif

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
