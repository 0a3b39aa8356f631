#nullable enable
using System;
using System.Runtime.InteropServices;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>Labels with their weights: one material, or a blend of up to four. A part of the blittable
    /// <see cref="ContactState"/>.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct LabelBlend : IEquatable<LabelBlend>
    {
        /// <summary>Maximum number of labels in a blend.</summary>
        public const int Maximum = 4;

        private int count;
        private int label0;
        private int label1;
        private int label2;
        private int label3;
        private float weight0;
        private float weight1;
        private float weight2;
        private float weight3;

        /// <summary>One label alone.</summary>
        /// <param name="label">Index into the model's labels.</param>
        public static LabelBlend Of(int label)
        {
            var blend = default(LabelBlend);
            blend.Add(label, 1.0f);
            return blend;
        }

        /// <summary>Two labels.</summary>
        /// <param name="share">Weight of the second label: 0 for the first alone, 1 for the second alone.</param>
        public static LabelBlend Of(int first, int second, float share)
        {
            float weight = share >= 0.0f ? Math.Min(share, 1.0f) : 0.0f;
            var blend = default(LabelBlend);
            if (weight < 1.0f)
            {
                blend.Add(first, 1.0f - weight);
            }
            if (weight > 0.0f)
            {
                blend.Add(second, weight);
            }
            return blend;
        }

        /// <summary>Number of labels, 0 to <see cref="Maximum"/>. The engine replaces an empty blend by the model's
        /// first label.</summary>
        public readonly int Count => count;

        /// <param name="label">Index into the model's labels.</param>
        /// <param name="weight">0 to 1; weights need not sum to 1.</param>
        /// <exception cref="InvalidOperationException">The blend is full.</exception>
        public void Add(int label, float weight)
        {
            switch (count)
            {
                case 0:
                    label0 = label;
                    weight0 = weight;
                    break;
                case 1:
                    label1 = label;
                    weight1 = weight;
                    break;
                case 2:
                    label2 = label;
                    weight2 = weight;
                    break;
                case 3:
                    label3 = label;
                    weight3 = weight;
                    break;
                default:
                    throw new InvalidOperationException("a blend has at most 4 labels");
            }
            ++count;
        }

        /// <summary>Index of a label, for entries 0 to <see cref="Count"/> - 1.</summary>
        public int Label(int index) => index == 0 ? label0 : index == 1 ? label1 : index == 2 ? label2 : label3;

        /// <summary>Weight of a label, for entries 0 to <see cref="Count"/> - 1.</summary>
        public float Weight(int index) => index == 0 ? weight0 : index == 1 ? weight1 : index == 2 ? weight2 : weight3;

        /// <inheritdoc/>
        public bool Equals(LabelBlend other)
        {
            bool same = Count == other.Count;
            for (int index = 0; same && index < Count; ++index)
            {
                same = Label(index) == other.Label(index) && Weight(index).Equals(other.Weight(index));
            }
            return same;
        }

        /// <inheritdoc/>
        public override bool Equals(object? other) => other is LabelBlend blend && Equals(blend);

        /// <inheritdoc/>
        public override int GetHashCode() => HashCode.Combine(Count, label0, label1, weight0, weight1);
    }
}
