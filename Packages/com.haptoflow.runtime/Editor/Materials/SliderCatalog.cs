#nullable enable
using System;
using System.IO;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>The sliders of a model: a file beside it, or the package's own for the package's model. Main thread;
    /// read anew only when the model is another.</summary>
    internal sealed class SliderCatalog
    {
        public const string DefaultPath = "Packages/com.haptoflow.runtime/Editor/Sliders/default.sliders.json";

        private static SliderCatalog? current;

        private readonly byte[] modelFile;

        private SliderCatalog(byte[] modelFile, SliderSet? sliders, string? problem)
        {
            this.modelFile = modelFile;
            Sliders = sliders;
            Problem = problem;
        }

        /// <summary>Null where the model has none.</summary>
        public SliderSet? Sliders { get; }

        /// <summary>Why there are no sliders; null where there are.</summary>
        public string? Problem { get; }

        /// <param name="model">Null where there is none.</param>
        public static SliderCatalog Of(HapticModelAsset? model)
        {
            byte[] file = model != null ? model.File : Array.Empty<byte>();
            if (current == null || !ReferenceEquals(current.modelFile, file))
            {
                current = model != null ? Read(model) : new SliderCatalog(file, null, "There is no model to move.");
            }
            return current;
        }

        /// <summary>Looks again: files came or went.</summary>
        public static void Forget() => current = null;

        private static SliderCatalog Read(HapticModelAsset model)
        {
            try
            {
                string space = ModelSpace.Of(model.File).Id;
                string own = Path.ChangeExtension(AssetDatabase.GetAssetPath(model), ".sliders.json") ?? "";
                string path = own.Length > 0 && File.Exists(FileUtil.GetPhysicalPath(own)) ? own : DefaultPath;
                SliderSet sliders = SliderSet.Read(File.ReadAllText(FileUtil.GetPhysicalPath(path)));
                return sliders.Space == space
                    ? new SliderCatalog(model.File, sliders, null)
                    : new SliderCatalog(model.File, null, $"This model has no sliders: those of {path} are for the " +
                        $"space {sliders.Space}, and the model's is {space}. `haptoflow-training sliders` " +
                        "makes its own, which belong beside the model with the ending .sliders.json.");
            }
            catch (Exception error) when (error is HaptoFlowException || error is IOException)
            {
                return new SliderCatalog(model.File, null, "The sliders cannot be read: " + error.Message);
            }
        }
    }
}
