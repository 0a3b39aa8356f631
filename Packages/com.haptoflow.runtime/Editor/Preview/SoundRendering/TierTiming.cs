#nullable enable
using System;
using System.Diagnostics;
using System.Linq;
using System.Threading;

namespace HaptoFlow.Preview
{
    /// <summary>Time that one segment of a tier takes on this machine.</summary>
    internal sealed class TierTiming
    {
        private const int WarmUps = 8;
        private const int Runs = 64;

        private TierTiming(double[] sortedMs)
        {
            Count = sortedMs.Length;
            MedianMs = Percentile(sortedMs, 0.5);
            Percentile90Ms = Percentile(sortedMs, 0.9);
        }

        /// <summary>Number of measurements.</summary>
        public int Count { get; }

        public double MedianMs { get; }

        /// <summary>90th percentile.</summary>
        public double Percentile90Ms { get; }

        /// <summary>Generates segments one after the other on the calling thread, the first ones without timing to warm
        /// the caches, as in the benchmarks' column "hot". Takes up to a second.</summary>
        /// <exception cref="OperationCanceledException">The token was cancelled.</exception>
        public static TierTiming Measure(HapticGenerator generator, float[] embedding, CancellationToken token)
        {
            var motion = new[] { 0.1f, 0.0f, 1.0f };
            var previous = new float[HapticGenerator.SegmentSamples];
            float[] noise = Noise();
            var segment = new float[HapticGenerator.SegmentSamples];
            var milliseconds = new double[Runs];
            var clock = new Stopwatch();
            for (int run = -WarmUps; run < Runs; ++run)
            {
                token.ThrowIfCancellationRequested();
                clock.Restart();
                generator.Generate(embedding, motion, previous, noise, segment);
                clock.Stop();
                segment.CopyTo(previous, 0);
                if (run >= 0)
                {
                    milliseconds[run] = clock.Elapsed.TotalMilliseconds;
                }
            }
            return Of(milliseconds);
        }

        /// <summary>Standard normal numbers, after Box and Muller. Which ones changes no time.</summary>
        private static float[] Noise()
        {
            var random = new Random(1);
            var noise = new float[HapticGenerator.SegmentSamples];
            for (int index = 0; index < noise.Length; ++index)
            {
                double size = Math.Sqrt(-2.0 * Math.Log(1.0 - random.NextDouble()));
                noise[index] = (float)(size * Math.Cos(2.0 * Math.PI * random.NextDouble()));
            }
            return noise;
        }

        /// <param name="milliseconds">At least one measurement.</param>
        internal static TierTiming Of(double[] milliseconds) =>
            new TierTiming(milliseconds.OrderBy(value => value).ToArray());

        /// <summary>By the nearest-rank method.</summary>
        private static double Percentile(double[] sorted, double share) =>
            sorted[Math.Max(0, (int)Math.Ceiling(share * sorted.Length) - 1)];
    }
}
