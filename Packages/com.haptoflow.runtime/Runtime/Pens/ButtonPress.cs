#nullable enable
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using System;
using UnityEngine.InputSystem;

namespace HaptoFlow
{
    /// <summary>Detects that one of several buttons with the same function goes down. Main thread.</summary>
    /// <remarks>InputAction.WasPressedThisFrame would do the same, but the Input System has it only from version 1.1,
    /// and this package accepts 1.0.</remarks>
    public sealed class ButtonPress : IDisposable
    {
        private readonly InputAction[] actions;
        private bool wasDown;

        /// <summary>Enables the buttons.</summary>
        /// <param name="bindings">Control paths of the Input System, for example "&lt;Keyboard&gt;/y".</param>
        public ButtonPress(params string[] bindings)
        {
            actions = Array.ConvertAll(bindings, path => new InputAction(binding: path));
            foreach (InputAction action in actions)
            {
                action.Enable();
            }
        }

        /// <summary>The path of the controller in the hand that does not hold the pen, with a slash at its end.
        /// </summary>
        public static string ControllerOppositeTo(PenHand penHand) =>
            "<XRController>{" + (penHand == PenHand.Right ? PenHand.Left : PenHand.Right) + "Hand}/";

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
        public void Dispose()
        {
            foreach (InputAction action in actions)
            {
                action.Dispose();
            }
        }
    }
}
#endif
