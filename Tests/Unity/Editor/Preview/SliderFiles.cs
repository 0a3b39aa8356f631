#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Makes files of sliders from a model's labels: a position of 1 adds a third of the difference of two
    /// labels.</summary>
    internal static class SliderFiles
    {
        public static string For(byte[] modelFile, string? space = null)
        {
            using HapticModel model = HapticModel.Open(modelFile);
            double[][] labels = model.Labels.Select(label => model.Embedding(label.Index)
                .Take(MaterialFile.TextureNumbers).Select(number => (double)number).ToArray()).ToArray();
            double[] mean = Enumerable.Range(0, MaterialFile.TextureNumbers)
                .Select(number => labels.Average(label => label[number])).ToArray();
            double[][] axes = Orthonormal(labels.Take(4).Select(label => Minus(label, mean))).ToArray();
            double[][] spread = axes.Select(axis => labels.Select(label => Dot(Minus(label, mean), axis)).ToArray()).ToArray();
            return JsonText.Of(new Dictionary<string, object?>
            {
                ["format"] = "haptoflow-sliders",
                ["version"] = 1,
                ["space"] = space ?? model.Space,
                ["sliders"] = new object[]
                {
                    Slider("coarseness", Scaled(Minus(labels[1], labels[0]), 1.0 / 3.0), 0.0),
                    Slider("hardness", Scaled(Minus(labels[3], labels[2]), 1.0 / 3.0), 0.0),
                    Slider("level", new double[MaterialFile.TextureNumbers], 6.0),
                },
                ["mean"] = mean,
                ["axes"] = axes,
                ["lowest"] = spread.Select(each => each.Min()).ToArray(),
                ["highest"] = spread.Select(each => each.Max()).ToArray(),
            });
        }

        public static double Dot(IReadOnlyList<double> one, IReadOnlyList<double> other) =>
            Enumerable.Range(0, other.Count).Sum(number => one[number] * other[number]);

        private static Dictionary<string, object?> Slider(string name, double[] direction, double decibels) =>
            new Dictionary<string, object?>
            {
                ["name"] = name,
                ["direction"] = direction,
                ["level_db"] = decibels,
                ["lowest"] = -1.0,
                ["highest"] = 1.0,
            };

        private static double[] Minus(double[] one, double[] other) =>
            one.Select((number, index) => number - other[index]).ToArray();

        private static double[] Scaled(double[] numbers, double factor) =>
            numbers.Select(number => factor * number).ToArray();

        /// <summary>Orthonormal vectors by the method of Gram and Schmidt.</summary>
        private static IEnumerable<double[]> Orthonormal(IEnumerable<double[]> directions)
        {
            var found = new List<double[]>();
            foreach (double[] direction in directions)
            {
                double[] rest = found.Aggregate(direction, (left, axis) => Minus(left, Scaled(axis, Dot(left, axis))));
                double length = Math.Sqrt(Dot(rest, rest));
                if (length > 1e-9)
                {
                    found.Add(Scaled(rest, 1.0 / length));
                }
            }
            return found;
        }
    }
}
