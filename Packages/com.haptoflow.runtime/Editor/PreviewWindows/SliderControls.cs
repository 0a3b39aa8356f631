#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Sliders that change the active material, and the button that saves it as an asset. Main thread, within
    /// OnGUI.</summary>
    internal sealed class SliderControls
    {
        private static readonly GUIContent Title = new GUIContent("Sliders",
            "Change the active material: its feature scale, its tone, and its embedding.");
        private static readonly GUIContent Reset =
            new GUIContent("Reset", "Resets all sliders: the feature scale to 1, the others to 0.");
        private static readonly GUIContent Save = new GUIContent("Save as Haptic Material\u2026",
            "Saves the changed material as an asset, with its feature scale and tone. The model does not change.");
        private static readonly GUIContent FeatureScale = new GUIContent("Feature Scale",
            "Scales the size of the material's features, its ribs included. The level does not change.");
        private static readonly GUIContent Tone = new GUIContent("Tone [dB/oct]",
            "Tilts the spectrum about 150 Hz. Above 0, high frequencies are stronger.");
        private static readonly Dictionary<string, string> Tooltips = new Dictionary<string, string>
        {
            ["coarseness"] = "Above 0 the texture is coarser, below 0 finer.",
            ["hardness"] = "Above 0 the material is harder, below 0 softer.",
            ["regularity"] = "Above 0 the texture is more regular, below 0 more random.",
            ["stickiness"] = "Above 0 there is more stick-slip, below 0 less.",
            ["level"] = "Above 0 the vibration is stronger, below 0 weaker.",
        };

        private readonly TexturePreviewState state;
        private readonly Dictionary<string, GUIContent> titles = new Dictionary<string, GUIContent>();

        // Copies from the last layout event: IMGUI needs the same controls in the events that follow it.
        private bool shows;
        private SliderCatalog? catalog;

        public SliderControls(TexturePreviewState state) => this.state = state;

        /// <param name="save">Called when the save button is pressed; must open its dialog after the event.</param>
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
            DrawSlider(FeatureScale, material.FeatureScale, MaterialDescription.MinimumFeatureScale,
                MaterialDescription.MaximumFeatureScale, value => material.FeatureScale = value);
            DrawSlider(Tone, material.ToneDbPerOctave, -MaterialDescription.MaximumToneDbPerOctave,
                MaterialDescription.MaximumToneDbPerOctave, value => material.ToneDbPerOctave = value);
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

        private void DrawSlider(GUIContent title, float present, float minimum, float maximum, Action<float> change) =>
            state.Enter(title.text, present, EditorGUILayout.Slider(title, present, minimum, maximum),
                (_, entered) => change(entered));

        private void DrawButtons(MaterialChoice material, Action save)
        {
            using (new EditorGUI.DisabledScope(material.IsAtRest))
            using (new EditorGUILayout.HorizontalScope())
            {
                if (GUILayout.Button(Reset, GUILayout.Width(64f)))
                {
                    state.Change("Reset Sliders", _ => material.ResetSliders());
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

    /// <summary>The sliders of a model: those in a file beside it, or the package's sliders for the package's model.
    /// They are read again when the model changes. Main thread.</summary>
    internal sealed class SliderCatalog
    {
        public const string DefaultPath = "Packages/com.haptoflow.runtime/Editor/default.sliders.json";

        private static SliderCatalog? current;

        private readonly byte[] modelFile;

        private SliderCatalog(byte[] modelFile, SliderSet? sliders, string? problem) =>
            (this.modelFile, Sliders, Problem) = (modelFile, sliders, problem);

        public SliderSet? Sliders { get; }
        public string? Problem { get; }

        public static SliderCatalog Of(HapticModelAsset? model)
        {
            byte[] file = model != null ? model.File : Array.Empty<byte>();
            if (current == null || !ReferenceEquals(current.modelFile, file))
            {
                current = model != null ? Read(model) : new SliderCatalog(file, null, "There is no model.");
            }
            return current;
        }

        /// <summary>Reads the sliders again at the next call, because files may have changed.</summary>
        public static void Forget() => current = null;

        private static SliderCatalog Read(HapticModelAsset model)
        {
            try
            {
                string space = model.Header.Space;
                string own = Path.ChangeExtension(AssetDatabase.GetAssetPath(model), ".sliders.json") ?? "";
                string path = own.Length > 0 && File.Exists(FileUtil.GetPhysicalPath(own)) ? own : DefaultPath;
                SliderSet sliders = SliderSet.Read(File.ReadAllText(FileUtil.GetPhysicalPath(path)));
                return sliders.Space == space
                    ? new SliderCatalog(model.File, sliders, null)
                    : new SliderCatalog(model.File, null, $"This model has no sliders: {path} is for the space " +
                        $"{sliders.Space}, but the model has the space {space}. Create its sliders with " +
                        "`haptoflow-training sliders`, and put them beside the model with the ending .sliders.json.");
            }
            catch (Exception error) when (error is HaptoFlowException || error is IOException)
            {
                return new SliderCatalog(model.File, null, "The sliders cannot be read: " + error.Message);
            }
        }
    }
}
