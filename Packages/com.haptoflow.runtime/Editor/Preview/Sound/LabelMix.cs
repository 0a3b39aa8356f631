#nullable enable
using System;
using System.Globalization;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
    /// <summary>A label, or two of them and a blend, by name.</summary>
    internal readonly struct LabelMix : IEquatable<LabelMix>
    {
        /// <param name="second">Empty for none.</param>
        /// <param name="share">0: the first label alone. 1: the second alone.</param>
        public LabelMix(string first, string second = "", float share = 0f)
        {
            First = first;
            Second = share > 0f ? second : "";
            Share = Second.Length > 0 ? share : 0f;
        }

        public string First { get; }

        /// <summary>Empty for none.</summary>
        public string Second { get; }

        /// <summary>0: the first label alone. 1: the second alone.</summary>
        public float Share { get; }

        /// <summary>For people, for example "wood 60 % + cork 40 %".</summary>
        public string Title => Second.Length == 0
            ? First
            : string.Format(CultureInfo.InvariantCulture, "{0} {1:0} % + {2} {3:0} %",
                First, 100f * (1f - Share), Second, 100f * Share);

        /// <exception cref="HaptoFlowException">The model does not have a label of that name.</exception>
        public LabelBlend In(LabelNames names) => Second.Length == 0
            ? LabelBlend.Of(Index(names, First))
            : LabelBlend.Of(Index(names, First), Index(names, Second), Share);

        public bool Equals(LabelMix other) =>
            First == other.First && Second == other.Second && Share.Equals(other.Share);

        public override bool Equals(object? other) => other is LabelMix mix && Equals(mix);

        public override int GetHashCode() => HashCode.Combine(First, Second, Share);

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
