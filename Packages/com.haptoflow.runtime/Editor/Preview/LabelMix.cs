#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
    /// <summary>A material to preview: a label or a learnt material, alone or blended with a second label. Immutable.
    /// </summary>
    internal readonly struct LabelMix : IEquatable<LabelMix>
    {
        private static readonly float[] AtRest = new float[0];

        private readonly float[]? moves;

        /// <param name="first">A label, or the name of the learnt material.</param>
        /// <param name="second">A label; empty for none.</param>
        /// <param name="share">Of the second: 0 for the first alone, 1 for the second alone.</param>
        /// <param name="learnt">The text of the learnt material's file; empty for a label.</param>
        /// <param name="moves">Positions of the sliders that change the first material; null if they are all 0.</param>
        /// <param name="featureScale">Feature scale, 0.25 to 4.</param>
        /// <param name="toneDbPerOctave">Tone: tilt of the spectrum about 150 Hz, -12 to 12.</param>
        public LabelMix(string first, string second = "", float share = 0f, string learnt = "", float[]? moves = null,
            float featureScale = 1f, float toneDbPerOctave = 0f)
        {
            First = first;
            Second = share > 0f ? second : "";
            Share = Second.Length > 0 ? share : 0f;
            Learnt = learnt;
            this.moves = moves == null || SliderSet.IsAtRest(moves) ? null : moves;
            FeatureScale = featureScale;
            ToneDbPerOctave = toneDbPerOctave;
        }

        public string First { get; }
        public string Second { get; }
        public float Share { get; }
        public string Learnt { get; }

        public IReadOnlyList<float> Moves => moves ?? AtRest;

        public float FeatureScale { get; }
        public float ToneDbPerOctave { get; }

        /// <summary>True if the first material is not one of the model's labels and must be registered with the engine.
        /// </summary>
        public bool IsRegistered => Learnt.Length > 0 || moves != null;

        /// <summary>A title, for example "wood 60 % + cork 40 %" or "corduroy (x2, +3 dB/oct)".</summary>
        public string Title
        {
            get
            {
                string first = moves == null ? First : First + ", moved";
                string labels = Second.Length == 0
                    ? first
                    : string.Format(CultureInfo.InvariantCulture, "{0} {1:0} % + {2} {3:0} %",
                        first, 100f * (1f - Share), Second, 100f * Share);
                return labels + ScaleAndTone;
            }
        }

        private string ScaleAndTone
        {
            get
            {
                string[] parts = new[]
                {
                    FeatureScale.Equals(1f) ? "" : Text("x{0:0.##}", FeatureScale),
                    ToneDbPerOctave.Equals(0f) ? "" : Text("{0:+0.##;-0.##;0} dB/oct", ToneDbPerOctave),
                }.Where(part => part.Length > 0).ToArray();
                return parts.Length == 0 ? "" : $" ({string.Join(", ", parts)})";
            }
        }

        /// <param name="registered">Index at which the engine registered the first material; -1 for a label.</param>
        /// <exception cref="HaptoFlowException">The model lacks a label.</exception>
        public LabelBlend ToBlend(LabelNames names, int registered)
        {
            int first = registered >= 0 ? registered : Index(names, First);
            return Second.Length == 0 ? LabelBlend.Of(first) : LabelBlend.Of(first, Index(names, Second), Share);
        }

        /// <summary>The text of a material file for the first material with the sliders' changes.</summary>
        /// <param name="sliders">Null if the model has none: then their positions are ignored.</param>
        /// <exception cref="HaptoFlowException">The model lacks the label, or the text is no material file.</exception>
        public string MaterialText(HapticModel model, SliderSet? sliders)
        {
            string text = Learnt.Length > 0 ? Learnt : HaptoFlow.Model.MaterialText.OfLabel(model, First);
            return sliders == null || moves == null
                ? text
                : sliders.Moved(MaterialFile.Read(text), moves, First + ", moved");
        }

        public bool Equals(LabelMix other) =>
            First == other.First && Second == other.Second && Share.Equals(other.Share) && Learnt == other.Learnt &&
            Moves.SequenceEqual(other.Moves) && FeatureScale.Equals(other.FeatureScale) &&
            ToneDbPerOctave.Equals(other.ToneDbPerOctave);

        public override bool Equals(object? other) => other is LabelMix mix && Equals(mix);

        public override int GetHashCode() => HashCode.Combine(First, Second, Share, Learnt.Length, FeatureScale,
            ToneDbPerOctave);

        private static string Text(string format, float number) =>
            string.Format(CultureInfo.InvariantCulture, format, number);

        private static int Index(LabelNames names, string label)
        {
            if (names.TryFind(label, out int index))
            {
                return index;
            }
            throw new HaptoFlowException(HaptoFlowStatus.InvalidArgument,
                $"the model has no label \"{label}\"; its labels are: {string.Join(", ", names.All)}");
        }
    }

    /// <summary>A slider: a direction in the embedding space along which a material is changed.</summary>
    internal sealed class MaterialSlider
    {
        internal MaterialSlider(JsonValue json)
        {
            Name = json["name"].AsText();
            Direction = SliderSet.Numbers(json["direction"], MaterialFile.TextureNumbers);
            LevelDecibels = json.Find("level_db") is { IsNull: false } level
                ? SliderSet.Number(level, -SliderSet.MaximumOffsetDecibels, SliderSet.MaximumOffsetDecibels)
                : 0.0;
            Lowest = (float)SliderSet.Number(json["lowest"], -10.0, 0.0);
            Highest = (float)SliderSet.Number(json["highest"], 0.0, 10.0);
        }

        public string Name { get; }

        /// <summary>Added to the embedding at a position of 1.</summary>
        public IReadOnlyList<double> Direction { get; }

        /// <summary>Added to the level at a position of 1.</summary>
        public double LevelDecibels { get; }

        public float Lowest { get; }
        public float Highest { get; }
    }

    /// <summary>The sliders of one model's embedding space, and the range of its labels' embeddings. Immutable; any
    /// thread.</summary>
    internal sealed class SliderSet
    {
        /// <summary>Largest offset of the level in a material file, either way.</summary>
        public const double MaximumOffsetDecibels = 24.0;

        private const string FormatName = "haptoflow-sliders";

        private readonly double[] mean;
        private readonly double[][] axes;
        private readonly double[] lowest;
        private readonly double[] highest;

        private SliderSet(JsonValue root)
        {
            if (root["format"].AsText() != FormatName)
            {
                throw root["format"].Expected($"\"{FormatName}\": this is not a file of sliders");
            }
            if (root["version"].AsInteger() != 1)
            {
                throw root["version"].Expected("1: update HaptoFlow");
            }
            Space = root["space"].AsText();
            Sliders = root["sliders"].AsArray().Select(each => new MaterialSlider(each)).ToArray();
            if (Sliders.Count == 0)
            {
                throw root["sliders"].Expected("a list of sliders");
            }
            const int size = MaterialFile.TextureNumbers;
            mean = Numbers(root["mean"], size);
            axes = root["axes"].AsArray().Select(row => Numbers(row, size)).ToArray();
            lowest = Numbers(root["lowest"], axes.Length);
            highest = Numbers(root["highest"], axes.Length);
        }

        /// <summary>The <see cref="HapticModel.Space"/> of the model whose materials the sliders change.</summary>
        public string Space { get; }

        public IReadOnlyList<MaterialSlider> Sliders { get; }

        /// <exception cref="HaptoFlowException">The text is no file of sliders; the message names the key.</exception>
        public static SliderSet Read(string text)
        {
            try
            {
                return new SliderSet(JsonValue.Parse(text));
            }
            catch (FormatException error)
            {
                throw new HaptoFlowException(HaptoFlowStatus.MaterialInvalid, error.Message, error);
            }
        }

        internal static double Number(JsonValue json, double low, double high)
        {
            double number = json.AsNumber();
            return number >= low && number <= high
                ? number
                : throw json.Expected(FormattableString.Invariant($"a number from {low:R} to {high:R}"));
        }

        internal static double[] Numbers(JsonValue list, int count) => list.AsArray().Count == count
            ? list.AsArray().Select(each => Number(each, -1e6, 1e6)).ToArray()
            : throw list.Expected(FormattableString.Invariant($"a list of {count} numbers"));

        public static bool IsAtRest(IReadOnlyList<float> values) => values.All(value => value.Equals(0f));

        /// <summary>Applies the sliders to a material. The embedding stays within the range of the model's labels, or
        /// of the material itself if that is outside.</summary>
        /// <param name="values">Position of each slider; missing ones are 0.</param>
        /// <param name="name">Name of the new material.</param>
        /// <returns>The text of a material file.</returns>
        public string Moved(MaterialFile material, IReadOnlyList<float> values, string name)
        {
            double offset = material.LevelOffsetDecibels + Sliders.Select((slider, index) =>
                Value(values, index) * slider.LevelDecibels).Sum();
            offset = Math.Max(-MaximumOffsetDecibels, Math.Min(MaximumOffsetDecibels, offset));
            return MaterialText.With(material, new Dictionary<string, object?>
            {
                ["name"] = name,
                ["embedding"] = Moved(material.Embedding, values).Select(number => (float)number).ToArray(),
                ["level_offset_db"] = offset,
            });
        }

        /// <summary>Applies the sliders to an embedding; its wave vectors do not change.</summary>
        public double[] Moved(IReadOnlyList<double> embedding, IReadOnlyList<float> values)
        {
            double[] moved = embedding.ToArray();
            for (int index = 0; index < Sliders.Count; ++index)
            {
                double value = Value(values, index);
                for (int number = 0; number < MaterialFile.TextureNumbers; ++number)
                {
                    moved[number] += value * Sliders[index].Direction[number];
                }
            }
            for (int axis = 0; axis < axes.Length; ++axis)
            {
                double own = Coordinate(embedding, axis);
                double target = Coordinate(moved, axis);
                double limited = Math.Max(Math.Min(lowest[axis], own), Math.Min(Math.Max(highest[axis], own), target));
                for (int number = 0; number < MaterialFile.TextureNumbers; ++number)
                {
                    moved[number] += (limited - target) * axes[axis][number];
                }
            }
            return moved;
        }

        /// <summary>Projection of an embedding on a principal axis, relative to the mean of the labels.</summary>
        internal double Coordinate(IReadOnlyList<double> embedding, int axis)
        {
            double sum = 0.0;
            for (int number = 0; number < MaterialFile.TextureNumbers; ++number)
            {
                sum += (embedding[number] - mean[number]) * axes[axis][number];
            }
            return sum;
        }

        private float Value(IReadOnlyList<float> values, int index) => index < values.Count
            ? Math.Max(Sliders[index].Lowest, Math.Min(Sliders[index].Highest, values[index]))
            : 0f;
    }
}
