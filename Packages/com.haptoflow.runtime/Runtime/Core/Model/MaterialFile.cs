#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;

namespace HaptoFlow.Model
{
    /// <summary>A learnt material: a label with its embedding, in a text of its own (a .haptomaterial file). The native
    /// library checks the rest when it takes the text. Any thread.</summary>
    public sealed class MaterialFile
    {
        /// <summary>Numbers of an embedding that are the texture; the last four are wave vectors.</summary>
        public const int TextureNumbers = 60;

        /// <summary>Of the whole text, in UTF-8.</summary>
        public const int MaximumBytes = 1024 * 1024;

        private const int MostSeeds = 16;

        private MaterialFile(JsonValue json)
        {
            Json = json;
            Space = TextOf(json, "space");
            Name = TextOf(json, "name");
            Category = TextOf(json, "category");
            Description = TextOf(json, "description");
            JsonValue provenance = Of(json, "provenance");
            Statement = OptionalText(provenance, "statement");
            Recordings = OptionalText(provenance, "recordings");
            Licence = OptionalText(provenance, "licence");
            Licence = Licence.Length > 0 ? Licence : "unknown";
            Created = OptionalText(provenance, "created");
            Seconds = provenance.Find("seconds")?.AsNumber() ?? 0.0;
            Embedding = EmbeddingOf(json);
            StiffnessNewtonsPerMetre = Of(json, "stiffness_newtons_per_metre").AsNumber();
            LevelOffsetDecibels = json.Find("level_offset_db")?.AsNumber() ?? 0.0;
            if (json.Find("seeds")?.AsArray().Count > MostSeeds)
            {
                throw json["seeds"].Expected("a list of at most 16");
            }
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
                throw new HaptoFlowException(
                    HaptoFlowStatus.MaterialInvalid, "the text is larger than 1 MiB: this is no material file");
            }
            try
            {
                JsonValue json = JsonValue.Parse(text);
                CheckFormat(json);
                return new MaterialFile(json);
            }
            catch (FormatException error)
            {
                throw new HaptoFlowException(HaptoFlowStatus.MaterialInvalid, error.Message, error);
            }
        }

        private static void CheckFormat(JsonValue json)
        {
            JsonValue? format = json.Find("format");
            if (format == null || format.AsText() != "haptoflow-material")
            {
                throw new FormatException("format is not \"haptoflow-material\": this is no material file");
            }
            if (Of(json, "version").AsInteger() != 1)
            {
                throw new FormatException("version is not 1: update HaptoFlow");
            }
        }

        private static JsonValue Of(JsonValue json, string key) =>
            json.Find(key) ?? throw new FormatException($"the key \"{key}\" is missing");

        private static string TextOf(JsonValue json, string key) => Of(json, key).AsText();

        private static string OptionalText(JsonValue json, string key) => json.Find(key)?.AsText() ?? "";

        private static double[] EmbeddingOf(JsonValue json)
        {
            JsonValue embedding = Of(json, "embedding");
            double[] numbers = embedding.AsArray().Select(number => number.AsNumber()).ToArray();
            return numbers.Length == HapticModel.EmbeddingSize ? numbers : throw embedding.Expected("64 numbers");
        }
    }
}
