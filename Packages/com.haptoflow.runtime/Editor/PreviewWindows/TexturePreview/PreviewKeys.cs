#nullable enable
using System;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Keyboard shortcuts of the window, while no text is being edited.</summary>
    internal static class PreviewKeys
    {
        public const string Help = "Space: play or stop. A, B: switch material. Left, right: speed. Up, down: force. " +
            "Ctrl or Cmd + E: export.";

        // A constant ratio: four steps double the value.
        private static readonly float Step = (float)Math.Pow(2.0, 0.25);

        /// <returns>True if the key is a shortcut; the event is then used.</returns>
        public static bool Handle(Event input, TexturePreviewState state, Action play, Action export)
        {
            if (input.type != EventType.KeyDown || EditorGUIUtility.editingTextField)
            {
                return false;
            }
            Action? action = input.control || input.command || input.alt
                ? WithModifier(input, export)
                : Plain(input.keyCode, state, play);
            if (action == null)
            {
                return false;
            }
            action();
            input.Use();
            return true;
        }

        private static Action? WithModifier(Event input, Action export) =>
            EditorGUI.actionKey && input.keyCode == KeyCode.E ? export : null;

        private static Action? Plain(KeyCode key, TexturePreviewState state, Action play) => key switch
        {
            KeyCode.Space => play,
            KeyCode.A => () => Activate(state, 0),
            KeyCode.B => () => Activate(state, 1),
            KeyCode.LeftArrow => () => Speed(state, 1f / Step),
            KeyCode.RightArrow => () => Speed(state, Step),
            KeyCode.DownArrow => () => Force(state, 1f / Step),
            KeyCode.UpArrow => () => Force(state, Step),
            _ => null,
        };

        private static void Activate(TexturePreviewState state, int index) => state.Change("Material", changed =>
        {
            changed.Compares |= index == 1;
            changed.Active = index;
        });

        private static void Speed(TexturePreviewState state, float factor) => state.Change("Speed", changed =>
            changed.SpeedMps = Mathf.Clamp(
                changed.SpeedMps * factor, TexturePreviewState.MinimumSpeedMps, TexturePreviewState.MaximumSpeedMps));

        private static void Force(TexturePreviewState state, float factor) => state.Change("Force", changed =>
            changed.ForceNewtons = Mathf.Clamp(changed.ForceNewtons * factor, TexturePreviewState.MinimumForceNewtons,
                TexturePreviewState.MaximumForceNewtons));
    }
}
