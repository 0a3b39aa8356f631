#nullable enable
using System;
using System.Linq;

namespace HaptoFlow.Recordings
{
    /// <summary>Resamples velocity and force from their own clocks to that of the acceleration.</summary>
    internal static class RecordingMotion
    {
        // Window that smooths a tracker's steps; the speed of a hand changes more slowly.
        private const double SlopeSeconds = 0.05;

        /// <summary>Two velocity components in m/s per sample.</summary>
        /// <exception cref="HaptoFlowException">The numbers indicate another unit than the column's name.</exception>
        public static float[] Velocity(string file, Series motion, double firstSeconds, double rateHz, int count)
        {
            Series velocity = motion.Columns[0].StartsWith("position", StringComparison.Ordinal)
                ? Slopes(motion)
                : motion;
            RecordingChecks.CheckSpeeds(file, motion, Enumerable.Range(0, velocity.Count).Select(row =>
                Math.Sqrt(velocity.Values.Sum(axis => axis[row] * axis[row]))));
            double[][] axes = velocity.Values.Select((_, axis) =>
                velocity.At(axis, firstSeconds, 1.0 / rateHz, count)).ToArray();
            var result = new float[2 * count];
            for (int index = 0; index < count; ++index)
            {
                result[2 * index] = (float)(axes.Length == 1 ? Math.Abs(axes[0][index]) : axes[0][index]);
                result[2 * index + 1] = axes.Length == 1 ? 0f : (float)axes[1][index];
            }
            return result;
        }

        /// <summary>Force in N, not below 0, per sample.</summary>
        /// <exception cref="HaptoFlowException">The numbers indicate another unit than the column's name.</exception>
        public static float[] Force(string file, Series force, double firstSeconds, double rateHz, int count)
        {
            RecordingChecks.CheckForce(file, force);
            double[] newtons = force.At(0, firstSeconds, 1.0 / rateHz, count);
            return Array.ConvertAll(newtons, value => (float)Math.Max(0.0, value));
        }

        /// <summary>Derivative by a line fitted to the readings around each (Savitzky and Golay 1964, first
        /// order).</summary>
        private static Series Slopes(Series position)
        {
            int half = Math.Max(1, Math.Min((int)Math.Round(0.5 * SlopeSeconds / position.StepSeconds),
                (position.Count - 1) / 2));
            double[][] slopes = position.Values.Select(axis => Slopes(position.Seconds, axis, half)).ToArray();
            return new Series(position.Seconds, slopes, position.Columns);
        }

        private static double[] Slopes(double[] seconds, double[] metres, int half)
        {
            var result = new double[metres.Length];
            for (int row = 0; row < metres.Length; ++row)
            {
                int first = Math.Max(0, Math.Min(row - half, metres.Length - 1 - 2 * half));
                int count = Math.Min(2 * half + 1, metres.Length - first);
                double meanTime = 0.0;
                double meanPlace = 0.0;
                for (int index = first; index < first + count; ++index)
                {
                    meanTime += seconds[index] / count;
                    meanPlace += metres[index] / count;
                }
                double products = 0.0;
                double squares = 0.0;
                for (int index = first; index < first + count; ++index)
                {
                    products += (seconds[index] - meanTime) * (metres[index] - meanPlace);
                    squares += (seconds[index] - meanTime) * (seconds[index] - meanTime);
                }
                result[row] = products / squares;
            }
            return result;
        }
    }
}
