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
            "Move the material that is heard within what the model's labels span.");
        private static readonly GUIContent Reset =
            new GUIContent("Reset", "The material is as it was before the sliders moved it.");
        private static readonly GUIContent Save = new GUIContent("Save as Haptic Material\u2026",
            "An asset that carries the moved material; the model stays as it is.");
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
            if (catalog.Sliders == null)
            {
                EditorGUILayout.HelpBox(catalog.Problem!, MessageType.Info);
                return;
            }
            float before = EditorGUIUtility.labelWidth;
            EditorGUIUtility.labelWidth = PreviewControls.LabelWidth;
            MaterialChoice material = state.Material(state.Heard);
            for (int index = 0; index < catalog.Sliders.Sliders.Count; ++index)
            {
                DrawSlider(catalog.Sliders, material, index);
            }
            EditorGUIUtility.labelWidth = before;
            DrawButtons(material, save);
        }

        private void DrawSlider(SliderSet sliders, MaterialChoice material, int index)
        {
            MaterialSlider slider = sliders.Sliders[index];
            float present = index < material.Moves.Length ? material.Moves[index] : 0f;
            float entered = EditorGUILayout.Slider(TitleOf(slider.Name), present, slider.Lowest, slider.Highest);
            if (!entered.Equals(present))
            {
                var moves = new float[sliders.Sliders.Count];
                Array.Copy(material.Moves, moves, Math.Min(moves.Length, material.Moves.Length));
                moves[index] = entered;
                state.Change(slider.Name, _ => material.Moves = moves);
            }
        }

        private void DrawButtons(MaterialChoice material, Action save)
        {
            using (new EditorGUI.DisabledScope(SliderSet.IsAtRest(material.Moves)))
            using (new EditorGUILayout.HorizontalScope())
            {
                if (GUILayout.Button(Reset, GUILayout.Width(64f)))
                {
                    state.Change("Reset of Sliders", _ => material.Moves = Array.Empty<float>());
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
