#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;

namespace HaptoFlow.Model
{
    /// <summary>A learnt material: a label with its embedding, in a text of its own (a .haptomaterial file). Read and
    /// checked without the native library. Any thread.</summary>
    public sealed class MaterialFile
    {
        /// <summary>Numbers of an embedding that are the texture; the last four are wave vectors.</summary>
        public const int TextureNumbers = 60;

        /// <summary>Of the whole text, in UTF-8.</summary>
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
            LevelOffsetDecibels = root.OptionalNumber("level_offset_db", -MaterialRules.MostOffsetDecibels,
                MaterialRules.MostOffsetDecibels) ?? 0.0;
            MaterialRules.Check(root);
        }

        /// <summary>Eight hexadecimal digits: the <see cref="ModelSpace.Id"/> of the model that it was learnt for.
        /// </summary>
        public string Space { get; }

        /// <summary>Shown to people.</summary>
        public string Name { get; }

        /// <summary>For example "wood" or "cloth".</summary>
        public string Category { get; }

        /// <summary>One or two sentences; may be empty.</summary>
        public string Description { get; }

        /// <summary>How it was made.</summary>
        public string Statement { get; }

        /// <summary>What it was learnt from.</summary>
        public string Recordings { get; }

        /// <summary>Of the recordings; "unknown" where nobody said.</summary>
        public string Licence { get; }

        /// <summary>Of the recordings, in seconds; 0 where nobody said.</summary>
        public double Seconds { get; }

        /// <summary>YYYY-MM-DD, or empty.</summary>
        public string Created { get; }

        /// <summary><see cref="HapticModel.EmbeddingSize"/> numbers.</summary>
        public IReadOnlyList<double> Embedding { get; }

        /// <summary>Default of the spring model.</summary>
        public double StiffnessNewtonsPerMetre { get; }

        /// <summary>Added to the level, in dB.</summary>
        public double LevelOffsetDecibels { get; }

        internal JsonValue Json { get; }

        /// <param name="text">Of a whole .haptomaterial file.</param>
        /// <exception cref="HaptoFlowException">The text is none; the message names the key.</exception>
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
