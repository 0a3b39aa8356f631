#nullable enable
using System;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>What keys do in the window while no text is being edited.</summary>
    internal static class PreviewKeys
    {
        public const string Help = "Space plays. A and B switch. Left and right change the speed, up and down the " +
            "force. Ctrl or Cmd + E exports.";

        // Steps that sound alike wherever they start: four to the double.
        private static readonly float Step = (float)Math.Pow(2.0, 0.25);

        /// <returns>The key meant something, and is used up.</returns>
        public static bool Handle(Event input, TexturePreviewState state, Action play, Action export)
        {
            if (input.type != EventType.KeyDown || EditorGUIUtility.editingTextField)
            {
                return false;
            }
            Action? wanted = input.control || input.command || input.alt
                ? WithModifier(input, export)
                : Plain(input.keyCode, state, play);
            if (wanted == null)
            {
                return false;
            }
            wanted();
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
