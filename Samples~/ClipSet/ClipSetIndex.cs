#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Samples.ClipSet
{
    /// <summary>What the file index.json of an exported set says.</summary>
    public sealed class ClipSetIndex
    {
        private readonly Dictionary<string, string[,]> files = new Dictionary<string, string[,]>();

        /// <exception cref="FormatException">The text is not the index of a set; the message names the key.</exception>
        public ClipSetIndex(string text)
        {
            JsonValue index = JsonValue.Parse(text);
            if (index["format"].AsText() != "haptoflow clip set" || index["version"].AsInteger() != 1)
            {
                throw new FormatException("format and version are not those of a clip set of version 1");
            }
            Speeds = Grid(index["speeds_mps"]);
            Forces = Grid(index["forces_newtons"]);
            foreach (JsonValue label in index["labels"].AsArray())
            {
                var names = new string[Speeds.Length, Forces.Length];
                foreach (JsonValue clip in label["clips"].AsArray())
                {
                    int speed = Array.IndexOf(Speeds, clip["speed_mps"].AsNumber());
                    int force = Array.IndexOf(Forces, clip["force_newtons"].AsNumber());
                    if (speed < 0 || force < 0)
                    {
                        throw new FormatException($"{clip.Path} is of a speed or a force that the set does not list");
                    }
                    names[speed, force] = clip["files"]["wav"].AsText();
                }
                files[label["label"].AsText()] = names;
            }
        }

        /// <summary>In m/s, rising.</summary>
        public double[] Speeds { get; }

        /// <summary>In newtons, rising.</summary>
        public double[] Forces { get; }

        public bool Has(string label) => files.ContainsKey(label);

        /// <summary>The name of the clip's audio asset; null where the set has no such file.</summary>
        public string? NameOf(string label, int speed, int force) =>
            Path.GetFileNameWithoutExtension(files[label][speed, force]);

        private static double[] Grid(JsonValue values)
        {
            double[] grid = values.AsArray().Select(value => value.AsNumber()).ToArray();
            bool rises = grid.Length > 0 && grid[0] > 0.0;
            for (int index = 1; index < grid.Length; ++index)
            {
                rises &= grid[index] > grid[index - 1];
            }
            return rises ? grid : throw new FormatException($"{values.Path} is not a list of rising numbers above 0");
        }
    }

    /// <summary>Where a speed or a force lies between the two nearest of a set: the rule "how_to_blend" of
    /// index.json.</summary>
    public readonly struct ClipBlend
    {
        private readonly int lower;
        private readonly double share;
        private readonly double factor;

        /// <param name="grid">Rising, above 0.</param>
        public ClipBlend(double[] grid, double value)
        {
            int last = grid.Length - 1;
            lower = 0;
            while (lower < last - 1 && value >= grid[lower + 1])
            {
                ++lower;
            }
            share = last > 0 && value > grid[lower]
                ? Math.Min(1.0, Math.Log(value / grid[lower]) / Math.Log(grid[lower + 1] / grid[lower]))
                : 0.0;
            factor = value >= grid[0] ? 1.0 : value > 0.0 ? value / grid[0] : 0.0;
        }

        /// <summary>The gain of a clip: clips are not correlated, so their powers add up.</summary>
        public static float Gain(in ClipBlend speeds, int speed, in ClipBlend forces, int force) =>
            (float)(Math.Sqrt(speeds.Weight(speed) * forces.Weight(force)) * speeds.factor * forces.factor);

        private double Weight(int index) => index == lower ? 1.0 - share : index == lower + 1 ? share : 0.0;
    }
}
