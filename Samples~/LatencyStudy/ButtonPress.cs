#nullable enable
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using System;
using UnityEngine.InputSystem;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>One of several buttons that do the same.</summary>
    public sealed class ButtonPress : IDisposable
    {
        private readonly InputAction[] actions;
        private bool wasDown;

        /// <param name="bindings">Paths of controls.</param>
        public ButtonPress(params string[] bindings)
        {
            actions = Array.ConvertAll(bindings, path => new InputAction(binding: path));
            foreach (InputAction action in actions)
            {
                action.Enable();
            }
        }

        /// <summary>True in the frame in which one goes down. Once a frame.</summary>
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

        /// <summary>Lets go of the buttons.</summary>
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
