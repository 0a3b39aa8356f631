#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
    /// <summary>A slider: a direction in the embedding space along which a material is changed.</summary>
    internal sealed class MaterialSlider
    {
        internal MaterialSlider(CheckedTable table)
        {
            Name = table.Text("name");
            Direction = table.Numbers("direction", MaterialFile.TextureNumbers);
            LevelDecibels = table.OptionalNumber("level_db", -SliderSet.MaximumOffsetDecibels,
                SliderSet.MaximumOffsetDecibels) ?? 0.0;
            Lowest = (float)table.Number("lowest", -10.0, 0.0);
            Highest = (float)table.Number("highest", 0.0, 10.0);
        }

        /// <summary>For example "coarseness".</summary>
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
        private const int MaximumSliders = 16;

        private readonly double[] mean;
        private readonly double[][] axes;
        private readonly double[] lowest;
        private readonly double[] highest;

        private SliderSet(CheckedTable root)
        {
            if (!root.Has("format") || root.Text("format") != FormatName)
            {
                throw root.Failure("format", $"\"{FormatName}\"", "this is not a file of sliders");
            }
            if (root.Integer("version") != 1)
            {
                throw root.Failure("version", "1", "update HaptoFlow");
            }
            Space = root.Text("space");
            Sliders = root.Tables("sliders", 1, MaximumSliders).Select(each => new MaterialSlider(each)).ToArray();
            const int size = MaterialFile.TextureNumbers;
            mean = root.Numbers("mean", size);
            axes = root.Rows("axes", size, -1.0, 1.0);
            lowest = root.Numbers("lowest", axes.Length);
            highest = root.Numbers("highest", axes.Length);
        }

        /// <summary>The <see cref="HapticModel.Space"/> of the model whose materials the sliders change.</summary>
        public string Space { get; }

        public IReadOnlyList<MaterialSlider> Sliders { get; }

        /// <exception cref="HaptoFlowException">The text is no file of sliders; the message names the key.</exception>
        public static SliderSet Read(string text)
        {
            try
            {
                return new SliderSet(new CheckedTable(JsonValue.Parse(text)));
            }
            catch (FormatException error)
            {
                throw new HaptoFlowException(HaptoFlowStatus.MaterialInvalid, error.Message, error);
            }
        }

        /// <summary>True if every slider is at 0.</summary>
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
