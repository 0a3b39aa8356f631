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
}
