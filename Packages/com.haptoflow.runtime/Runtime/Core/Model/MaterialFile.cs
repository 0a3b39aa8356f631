#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;

namespace HaptoFlow.Model
{
    /// <summary>A learnt material: the contents of a .haptomaterial file, a label with its embedding. Read and checked
    /// without the native library. Any thread.</summary>
    public sealed class MaterialFile
    {
        /// <summary>Number of an embedding's components that describe the texture; the last four are wave
        /// vectors.</summary>
        public const int TextureNumbers = 60;

        /// <summary>Maximum length of the text in UTF-8.</summary>
        public const int MaximumBytes = 1024 * 1024;

        private const string FormatName = "haptoflow-material";

        private MaterialFile(JsonValue json)
        {
            Json = json;
            var root = new CheckedTable(json);
            CheckFormat(root);
            Space = root.Text("space");
            if (Space.Length != 8 || Space.Any(letter => "0123456789abcdef".IndexOf(letter) < 0))
            {
                throw root.Failure("space", "eight lower-case hexadecimal digits");
            }
            Name = root.Text("name");
            if (Name.Trim().Length == 0)
            {
                throw root.Failure("name", "a name that is not empty");
            }
            Category = root.Text("category", "");
            Description = root.Text("description", "");
            CheckedTable? provenance = root.OptionalTable("provenance");
            Statement = provenance?.Text("statement", "") ?? "";
            Recordings = provenance?.Text("recordings", "") ?? "";
            Licence = provenance?.Text("licence", "unknown") ?? "unknown";
            Created = provenance?.Text("created", "") ?? "";
            Seconds = provenance?.OptionalNumber("seconds", 0.0, 1e9) ?? 0.0;
            Embedding = root.Numbers("embedding", HapticModel.EmbeddingSize, HapticModel.EmbeddingSize);
            StiffnessNewtonsPerMetre = root.Number("stiffness_newtons_per_metre", 1e-3, 1e6);
            LevelOffsetDecibels = root.OptionalNumber("level_offset_db", -MaterialRules.MaximumOffsetDecibels,
                MaterialRules.MaximumOffsetDecibels) ?? 0.0;
            MaterialRules.Check(root);
        }

        /// <summary>The <see cref="ModelSpace.Id"/> of the model that the material was learnt for.</summary>
        public string Space { get; }

        /// <summary>Name for display.</summary>
        public string Name { get; }

        /// <summary>For example "wood" or "cloth".</summary>
        public string Category { get; }

        /// <summary>One or two sentences; may be empty.</summary>
        public string Description { get; }

        /// <summary>How the material was made.</summary>
        public string Statement { get; }

        /// <summary>The recordings that the material was learnt from.</summary>
        public string Recordings { get; }

        /// <summary>Licence of the recordings; "unknown" where not given.</summary>
        public string Licence { get; }

        /// <summary>Duration of the recordings in seconds; 0 where not given.</summary>
        public double Seconds { get; }

        /// <summary>Date as YYYY-MM-DD, or empty.</summary>
        public string Created { get; }

        /// <summary>The embedding, <see cref="HapticModel.EmbeddingSize"/> numbers.</summary>
        public IReadOnlyList<double> Embedding { get; }

        /// <summary>Default stiffness of the spring model.</summary>
        public double StiffnessNewtonsPerMetre { get; }

        /// <summary>Offset of the level, in dB.</summary>
        public double LevelOffsetDecibels { get; }

        internal JsonValue Json { get; }

        /// <param name="text">The whole .haptomaterial file.</param>
        /// <exception cref="HaptoFlowException">The text is not a material file; the message names the key.</exception>
        public static MaterialFile Read(string text)
        {
            if (text.Length > MaximumBytes || Encoding.UTF8.GetByteCount(text) > MaximumBytes)
            {
                throw new HaptoFlowException(HaptoFlowStatus.MaterialInvalid,
                    "the file is longer than 1048576 bytes; a material file has at most that many");
            }
            try
            {
                return new MaterialFile(JsonValue.Parse(text));
            }
            catch (FormatException error)
            {
                throw new HaptoFlowException(HaptoFlowStatus.MaterialInvalid, error.Message, error);
            }
        }

        private static void CheckFormat(CheckedTable root)
        {
            if (!root.Has("format") || root.Text("format") != FormatName)
            {
                throw root.Failure("format", $"\"{FormatName}\"", "this is not a material file");
            }
            int version = root.Integer("version");
            if (version != 1)
            {
                throw root.Failure("version", "1", $"this reader does not know version {version}; update HaptoFlow");
            }
        }
    }
}
