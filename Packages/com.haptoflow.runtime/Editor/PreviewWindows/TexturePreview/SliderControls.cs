#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The window's sliders: they move the material that is heard, and what comes of it is saved as an asset.
    /// Main thread, within OnGUI.</summary>
    internal sealed class SliderControls
    {
        private static readonly GUIContent Title = new GUIContent("Sliders",
            "They change the material that is heard: its features, its tone, and its place among the model's labels.");
        private static readonly GUIContent Reset =
            new GUIContent("Reset", "All sliders rest: nothing is moved, the feature scale is 1, the tone 0.");
        private static readonly GUIContent Save = new GUIContent("Save as Haptic Material\u2026",
            "An asset that carries the moved material, its feature scale and its tone; the model stays as it is.");
        private static readonly GUIContent FeatureScale = new GUIContent("Feature Scale",
            "The material's features, its ribs included, are this many times as large. The level stays as it is.");
        private static readonly GUIContent Tone = new GUIContent("Tone [dB/oct]",
            "The spectrum is tilted about 150 Hz: above 0 it is brighter, below 0 darker.");
        private static readonly Dictionary<string, string> Tooltips = new Dictionary<string, string>
        {
            ["coarseness"] = "Above 0 the grain is coarser, below 0 finer.",
            ["hardness"] = "Above 0 it is harder, below 0 softer.",
            ["regularity"] = "Above 0 it is more regular, below 0 more random.",
            ["stickiness"] = "Above 0 the tip sticks and slips more, below 0 less.",
            ["level"] = "Above 0 it is stronger, below 0 weaker.",
        };

        private readonly TexturePreviewState state;
        private readonly Dictionary<string, GUIContent> titles = new Dictionary<string, GUIContent>();

        // As laid out: what changes in the midst of an event must not bring controls that nobody laid out.
        private bool shows;
        private SliderCatalog? catalog;

        public SliderControls(TexturePreviewState state) => this.state = state;

        /// <param name="save">Asks where to, when the event is over.</param>
        public void Draw(HapticModelAsset? model, Action save)
        {
            if (Event.current.type == EventType.Layout)
            {
                shows = state.ShowsSliders;
                catalog = SliderCatalog.Of(model);
            }
            bool opened = EditorGUILayout.Foldout(state.ShowsSliders, Title, true);
            if (opened != state.ShowsSliders)
            {
                state.Change("Sliders", changed => changed.ShowsSliders = opened);
            }
            if (!shows || catalog == null)
            {
                return;
            }
            float before = EditorGUIUtility.labelWidth;
            EditorGUIUtility.labelWidth = PreviewControls.LabelWidth;
            MaterialChoice material = state.Material(state.PlayedIndex);
            DrawSlider(FeatureScale, material.FeatureScale, MaterialDescription.SmallestFeatureScale,
                MaterialDescription.LargestFeatureScale, value => material.FeatureScale = value);
            DrawSlider(Tone, material.ToneDbPerOctave, -MaterialDescription.MostToneDbPerOctave,
                MaterialDescription.MostToneDbPerOctave, value => material.ToneDbPerOctave = value);
            if (catalog.Sliders == null)
            {
                EditorGUILayout.HelpBox(catalog.Problem!, MessageType.Info);
            }
            for (int index = 0; index < (catalog.Sliders?.Sliders.Count ?? 0); ++index)
            {
                DrawMove(catalog.Sliders!, material, index);
            }
            EditorGUIUtility.labelWidth = before;
            DrawButtons(material, save);
        }

        private void DrawMove(SliderSet sliders, MaterialChoice material, int index)
        {
            MaterialSlider slider = sliders.Sliders[index];
            float present = index < material.Moves.Length ? material.Moves[index] : 0f;
            DrawSlider(TitleOf(slider.Name), present, slider.Lowest, slider.Highest, entered =>
            {
                var moves = new float[sliders.Sliders.Count];
                Array.Copy(material.Moves, moves, Math.Min(moves.Length, material.Moves.Length));
                moves[index] = entered;
                material.Moves = moves;
            });
        }

        private void DrawSlider(GUIContent title, float present, float lowest, float highest, Action<float> change)
        {
            float entered = EditorGUILayout.Slider(title, present, lowest, highest);
            if (!entered.Equals(present))
            {
                state.Change(title.text, _ => change(entered));
            }
        }

        private void DrawButtons(MaterialChoice material, Action save)
        {
            using (new EditorGUI.DisabledScope(material.IsAtRest))
            using (new EditorGUILayout.HorizontalScope())
            {
                if (GUILayout.Button(Reset, GUILayout.Width(64f)))
                {
                    state.Change("Reset of Sliders", _ => material.Rest());
                }
                if (GUILayout.Button(Save))
                {
                    save();
                }
            }
        }

        private GUIContent TitleOf(string name)
        {
            if (!titles.TryGetValue(name, out GUIContent title))
            {
                string words = char.ToUpperInvariant(name[0]) + name.Substring(1);
                title = new GUIContent(words, Tooltips.TryGetValue(name, out string tooltip) ? tooltip : "");
                titles[name] = title;
            }
            return title;
        }
    }
}
