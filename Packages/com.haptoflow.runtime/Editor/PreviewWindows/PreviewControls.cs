#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Controls for materials, stroke, effects, device and quality. Main thread, within OnGUI.</summary>
    internal sealed class PreviewControls
    {
        public const float LabelWidth = 96f;

        private static readonly string[] StrokeNames =
        {
            "Slide", "Back and Forth", "Spiral", "Accelerating", "Pressing", "Taps", "Drawn", "Rims",
        };

        private static readonly string[] DeviceNames =
        {
            "Actuator (waveform)", "Controller (frames)", "Motor (160 Hz)",
        };

        private static readonly GUIContent[] EffectTitles =
        {
            new GUIContent("Texture", "Vibration of the material while the tip slides."),
            new GUIContent("Impact", "Transient at touch-down; its strength follows the approach speed."),
            new GUIContent("Edge", "Transient at each edge of the geometry."),
        };

        private static readonly GUIContent Effects = new GUIContent("Effects",
            "Effects of the surface.");
        private static readonly GUIContent Device = new GUIContent("Device",
            "The device that plays the waveform. The simulated output of a controller or a motor is shown as B " +
            "beside the waveform.");
        private static readonly GUIContent Landing = new GUIContent("Landing [m/s]",
            "Normal speed at each touch-down. A drop from 5 cm ends with 1 m/s.");

        private static readonly GUIContent Model =
            new GUIContent("Model", "The .haptoflow model to preview. None: the project's model.");
        private static readonly GUIContent First = new GUIContent("Material A", "A label of the model.");
        private static readonly GUIContent Second =
            new GUIContent("Material B", "A label of the model, to compare with A.");
        private static readonly GUIContent Blend =
            new GUIContent("Blend with", "A second label to blend with the first.");
        private static readonly GUIContent Share =
            new GUIContent("Share", "Share of the second label in the blend. 0: only the first. 1: only the second.");
        private static readonly GUIContent Compare =
            new GUIContent("Compare", "Shows a second material beside the first, with the same axes.");
        private static readonly GUIContent Relief = new GUIContent("Relief",
            "Heights under the stroke. The map begins at the lower left corner of the patch.");
        private static readonly GUIContent StrokeChoice =
            new GUIContent("Stroke", "Motion of the tip. A stroke drawn on the patch replaces it.");
        private static readonly GUIContent Speed =
            new GUIContent("Speed [m/s]", "Tangential speed. Left and right arrow keys change it.");
        private static readonly GUIContent Force = new GUIContent("Force [N]",
            "Normal force. Up and down arrow keys change it. A pen has this force at half its maximum pressure.");
        private static readonly GUIContent Direction = new GUIContent("Direction [\u00b0]",
            "0: the surface's first axis, to the right. 90: the second axis, upwards.");
        private static readonly GUIContent Contact =
            new GUIContent("Contact [s]", "Time from the first touch-down to the last lift-off.");
        private static readonly GUIContent Quality =
            new GUIContent("Quality", "The tier that renders. The table shows the time and accuracy of each.");
        private static readonly GUIContent Seed =
            new GUIContent("Seed", "Seed of the noise generator. The same seed gives the same samples.");

        private readonly TexturePreviewState state;

        // Copies from the last layout event: IMGUI needs the same controls in the events that follow it.
        private readonly bool[] blends = new bool[2];
        private bool compares;

        public PreviewControls(TexturePreviewState state) => this.state = state;

        public void Draw(PreviewModel model)
        {
            if (Event.current.type == EventType.Layout)
            {
                compares = state.ShowsSecond;
                blends[0] = state.First.SecondLabel.Length > 0;
                blends[1] = state.Second.SecondLabel.Length > 0;
            }
            float before = EditorGUIUtility.labelWidth;
            EditorGUIUtility.labelWidth = LabelWidth;
            state.DrawModel(Model);
            DrawMaterial(First, state.First, model, 0);
            using (new EditorGUI.DisabledScope(state.ShowsDevice))
            {
                state.Enter("Compare", state.Compares, EditorGUILayout.Toggle(Compare, state.Compares),
                    (changed, value) => changed.Compares = value);
            }
            if (compares)
            {
                DrawMaterial(Second, state.Second, model, 1);
            }
            state.Enter("Relief", state.Relief,
                (HapticRelief?)EditorGUILayout.ObjectField(Relief, state.Relief, typeof(HapticRelief), false),
                (changed, chosen) => changed.Relief = chosen);
            EditorGUILayout.Space(4f);
            DrawStroke();
            DrawEffects();
            EditorGUILayout.Space(4f);
            int device = (int)state.Device;
            state.Enter("Device", device, EditorGUILayout.Popup(Device, device, DeviceNames),
                (changed, value) => changed.Device = (PreviewDevice)value);
            DrawQuality(model);
            EditorGUIUtility.labelWidth = before;
        }

        private void DrawMaterial(GUIContent title, MaterialChoice material, PreviewModel model, int index)
        {
            string present = material.NameOr(model.Labels, index) + (material.Learnt != null ? " (learnt)" : "");
            DrawLabel(title, present, model.Labels, false, name => state.Change("Label", _ => material.Choose(name)));
            DrawLabel(Blend, material.SecondLabel, model.Labels, true,
                name => state.Change("Blend", _ => material.SecondLabel = name));
            if (blends[index])
            {
                DrawSlider(Share, material.Share, 0f, 1f, (_, value) => material.Share = value);
            }
        }

        private void DrawStroke()
        {
            int preset = (int)state.Preset;
            state.Enter("Stroke", preset, EditorGUILayout.Popup(StrokeChoice, preset, StrokeNames),
                (changed, value) => changed.Preset = (StrokePreset)value);
            DrawSlider(Speed, state.SpeedMps, TexturePreviewState.MinimumSpeedMps, TexturePreviewState.MaximumSpeedMps,
                (changed, value) => changed.SpeedMps = value);
            DrawSlider(Force, state.ForceNewtons, TexturePreviewState.MinimumForceNewtons,
                TexturePreviewState.MaximumForceNewtons, (changed, value) => changed.ForceNewtons = value);
            DrawSlider(Direction, state.DirectionDegrees, 0f, 360f,
                (changed, value) => changed.DirectionDegrees = value);
            DrawSlider(Contact, state.ContactSeconds, 0.2f, TexturePreviewState.MaximumSeconds,
                (changed, value) => changed.ContactSeconds = value);
        }

        private void DrawEffects()
        {
            DrawSlider(Landing, state.LandingMps, TexturePreviewState.MinimumLandingMps,
                TexturePreviewState.MaximumLandingMps, (changed, value) => changed.LandingMps = value);
            Rect rest = EditorGUI.PrefixLabel(EditorGUILayout.GetControlRect(), Effects);
            rest.width /= EffectTitles.Length;
            DrawEffect(rest, 0, state.HasTexture, (changed, value) => changed.HasTexture = value);
            rest.x += rest.width;
            DrawEffect(rest, 1, state.HasImpact, (changed, value) => changed.HasImpact = value);
            rest.x += rest.width;
            DrawEffect(rest, 2, state.HasEdge, (changed, value) => changed.HasEdge = value);
        }

        private void DrawEffect(Rect place, int index, bool value, Action<TexturePreviewState, bool> change) =>
            state.Enter(
                EffectTitles[index].text, value, EditorGUI.ToggleLeft(place, EffectTitles[index], value), change);

        private void DrawQuality(PreviewModel model)
        {
            string[] tiers = model.Tiers.ToArray();
            int present = Array.IndexOf(tiers, model.TierOrDefault(state.Tier));
            state.Enter("Quality", present, EditorGUILayout.Popup(Quality, present, tiers),
                (changed, tier) => changed.Tier = tiers[tier]);
            state.Enter("Seed", state.Seed, EditorGUILayout.IntField(Seed, state.Seed),
                (changed, seed) => changed.Seed = seed);
        }

        private void DrawSlider(GUIContent title, float value, float minimum, float maximum,
            Action<TexturePreviewState, float> change) =>
            state.Enter(
                title.text.Split(' ')[0], value, EditorGUILayout.Slider(title, value, minimum, maximum), change);

        private static void DrawLabel(
            GUIContent title, string present, IReadOnlyList<string> labels, bool canBeEmpty, Action<string> choose)
        {
            Rect field = EditorGUI.PrefixLabel(EditorGUILayout.GetControlRect(), title);
            var shown = new GUIContent(present.Length > 0 ? present : "none", title.tooltip);
            if (EditorGUI.DropdownButton(field, shown, FocusType.Keyboard))
            {
                IEnumerable<LabelOption> none = canBeEmpty
                    ? new[] { new LabelOption("none", "") }
                    : Array.Empty<LabelOption>();
                IEnumerable<LabelOption> all = labels.OrderBy(name => name, StringComparer.OrdinalIgnoreCase)
                    .Select(name => new LabelOption(name, name));
                new LabelDropdown(none.Concat(all).ToArray(), choose).Show(field);
            }
        }
    }

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
