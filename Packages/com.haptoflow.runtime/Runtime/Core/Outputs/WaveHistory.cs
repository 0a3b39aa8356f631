#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>The newest stretch of a wave, by position from its beginning. The voice renders at this rate, the lowest
    /// that it knows; a device's own rate is taken from here by <see cref="WaveDecimator"/>.</summary>
    public sealed class WaveHistory
    {
        /// <summary>Samples a second.</summary>
        public const double RateHz = 8000.0;

        private const int Size = 4096;
        private const int Mask = Size - 1;

        private readonly float[] samples = new float[Size];

        /// <summary>Samples since the beginning.</summary>
        public long End { get; private set; }

        /// <summary>The longest stretch that can be appended and read back at once.</summary>
        public static double CapacitySeconds => Size / RateHz;

        /// <summary>0 where the position was never written or is forgotten.</summary>
        public float this[long position] =>
            position >= 0 && position < End && position >= End - Size ? samples[position & Mask] : 0f;

        /// <summary>Takes the next samples from a source.</summary>
        /// <param name="end">The position behind the last one.</param>
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
                    // NaN compares false.
                    block[index] = block[index] >= -1f && block[index] <= 1f ? block[index] : Limited(block[index]);
                }
                End += count;
            }
        }

        /// <summary>Largest magnitude between two positions.</summary>
        public float Peak(long from, long to)
        {
            float peak = 0f;
            for (long position = Math.Max(from, End - Size); position < Math.Min(to, End); ++position)
            {
                peak = Math.Max(peak, Math.Abs(samples[position & Mask]));
            }
            return peak;
        }

        /// <summary>Copies what was written last, oldest first.</summary>
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
