#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>Ring buffer of the newest samples of a wave, addressed by position. Voices render at this rate, the
    /// lowest that they support; <see cref="WaveDecimator"/> converts it to the device's.</summary>
    public sealed class WaveHistory
    {
        /// <summary>Sample rate in Hz.</summary>
        public const double RateHz = 8000.0;

        private const int Size = 4096;
        private const int Mask = Size - 1;

        private readonly float[] samples = new float[Size];

        /// <summary>Number of samples since the beginning.</summary>
        public long End { get; private set; }

        /// <summary>The sample at a position; 0 where it was never written or has been overwritten.</summary>
        public float this[long position] =>
            position >= 0 && position < End && position >= End - Size ? samples[position & Mask] : 0f;

        /// <summary>Renders samples from a source up to a position.</summary>
        /// <param name="end">The position after the last sample.</param>
        public void RenderTo(long end, IWaveSource source)
        {
            while (End < end)
            {
                int place = (int)(End & Mask);
                int count = (int)Math.Min(end - End, Size - place);
                Span<float> block = samples.AsSpan(place, count);
                source.Render(block);
                for (int index = 0; index < count; ++index)
                {
                    // A comparison with NaN is false.
                    block[index] = block[index] >= -1f && block[index] <= 1f ? block[index] : Limited(block[index]);
                }
                End += count;
            }
        }

        /// <summary>Peak magnitude between two positions.</summary>
        public float Peak(long from, long to)
        {
            float peak = 0f;
            for (long position = Math.Max(from, End - Size); position < Math.Min(to, End); ++position)
            {
                peak = Math.Max(peak, Math.Abs(samples[position & Mask]));
            }
            return peak;
        }

        /// <summary>Copies the newest samples, oldest first.</summary>
        public void CopyNewest(Span<float> target)
        {
            for (int index = 0; index < target.Length; ++index)
            {
                target[index] = this[End - target.Length + index];
            }
        }

        private static float Limited(float sample) => float.IsNaN(sample) ? 0f : Math.Sign(sample);
    }
}
