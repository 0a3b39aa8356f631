#nullable enable
using System;
using System.IO;
using HaptoFlow.Preview;
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>The sliders of a model: those in a file beside it, or the package's sliders for the package's model.
    /// They are read again when the model changes. Main thread.</summary>
    internal sealed class SliderCatalog
    {
        public const string DefaultPath = "Packages/com.haptoflow.runtime/Editor/Sliders/default.sliders.json";

        private static SliderCatalog? current;

        private readonly byte[] modelFile;

        private SliderCatalog(byte[] modelFile, SliderSet? sliders, string? problem) =>
            (this.modelFile, Sliders, Problem) = (modelFile, sliders, problem);

        /// <summary>The sliders; null when the model has none.</summary>
        public SliderSet? Sliders { get; }

        /// <summary>Why there are no sliders; null when there are.</summary>
        public string? Problem { get; }

        /// <summary>The sliders of a model.</summary>
        /// <param name="model">The model; null for none.</param>
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
