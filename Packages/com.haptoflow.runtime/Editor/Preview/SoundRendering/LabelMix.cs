#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
    /// <summary>A label or a learnt material, or one of them and a second label in a blend, by name.</summary>
    internal readonly struct LabelMix : IEquatable<LabelMix>
    {
        private static readonly float[] AtRest = new float[0];

        private readonly float[]? moves;

        /// <param name="second">Empty for none.</param>
        /// <param name="share">0: the first alone. 1: the second alone.</param>
        /// <param name="learnt">The text of the first one's material file; empty for a label.</param>
        /// <param name="moves">Where the sliders are that move the first one; null for nowhere.</param>
        /// <param name="featureScale">How many times as large the features of the whole are, 0.25 to 4.</param>
        /// <param name="toneDbPerOctave">Tilt of the whole's spectrum about 150 Hz, -12 to 12.</param>
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

        /// <summary>A label, or the name of the learnt material.</summary>
        public string First { get; }

        /// <summary>Empty for none.</summary>
        public string Second { get; }

        /// <summary>0: the first alone. 1: the second alone.</summary>
        public float Share { get; }

        /// <summary>The text of the first one's material file; empty for a label.</summary>
        public string Learnt { get; }

        /// <summary>Of the sliders; empty where they are at rest.</summary>
        public IReadOnlyList<float> Moves => moves ?? AtRest;

        /// <summary>How many times as large the features of the whole are, 0.25 to 4.</summary>
        public float FeatureScale { get; }

        /// <summary>Tilt of the whole's spectrum about 150 Hz, -12 to 12.</summary>
        public float ToneDbPerOctave { get; }

        /// <summary>The first one is no label of the model as it is.</summary>
        public bool IsOwn => Learnt.Length > 0 || moves != null;

        /// <summary>For people, for example "wood 60 % + cork 40 %" or "corduroy (x2, +3 dB/oct)".</summary>
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

        /// <summary>For people; empty where neither changes anything.</summary>
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

        /// <exception cref="HaptoFlowException">The model does not have a label of that name.</exception>
        public LabelBlend In(LabelNames names) => In(names, -1);

        /// <param name="own">Index of the first one in the engine, where it is no label; else -1.</param>
        /// <exception cref="HaptoFlowException">The model does not have a label of that name.</exception>
        public LabelBlend In(LabelNames names, int own)
        {
            int first = own >= 0 ? own : Index(names, First);
            return Second.Length == 0 ? LabelBlend.Of(first) : LabelBlend.Of(first, Index(names, Second), Share);
        }

        /// <summary>The text of the material that the first one is, once the sliders have moved it.</summary>
        /// <param name="sliders">Null where the model has none: then nothing moves.</param>
        /// <exception cref="HaptoFlowException">The model does not have the label, or the text is no material file.
        /// </exception>
        public string MaterialText(byte[] modelFile, SliderSet? sliders)
        {
            string text = Learnt.Length > 0 ? Learnt : HaptoFlow.Model.MaterialText.OfLabel(modelFile, First);
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
