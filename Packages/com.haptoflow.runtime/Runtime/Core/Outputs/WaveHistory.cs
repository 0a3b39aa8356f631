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

    /// <summary>Resamples a wave to a device's rate at any position between samples: a linear-phase low-pass
    /// (Kaiser-windowed sinc) that passes frequencies below 0.4 of that rate and suppresses aliases. Written here
    /// because a device's clock, not a fixed rate, says where each block is read; the native library's resamplers have a
    /// fixed rate.</summary>
    internal sealed class WaveDecimator
    {
        // Half width in device samples for 60 dB of attenuation with a transition from 0.4 to 0.6 of the device's rate.
        private const double FullHalfWidthSamples = 9.0;
        private const double MinimumHalfWidthSamples = 1.5;

        // At low rates the transition is widened to limit the delay.
        private const double MaximumDelaySeconds = 0.012;
        private const double KaiserBeta = 5.65;
        private const int PhasesPerSample = 64;

        private readonly float[] kernel;
        private readonly int halfWidth;

        /// <param name="rateHz">Rate of the device, above 0.</param>
        public WaveDecimator(double rateHz)
        {
            Step = WaveHistory.RateHz / rateHz;
            // Above the wave's own rate there are no aliases; the filter then only interpolates.
            double widest = Math.Max(1.0, Step);
            double halfSamples = Math.Min(FullHalfWidthSamples,
                Math.Max(MinimumHalfWidthSamples, MaximumDelaySeconds * WaveHistory.RateHz / widest));
            halfWidth = (int)Math.Ceiling(halfSamples * widest);
            kernel = new float[halfWidth * PhasesPerSample + 2];
            double cutoff = 1.0 / widest;
            double sum = 0.0;
            for (int index = 0; index < kernel.Length; ++index)
            {
                double distance = (double)index / PhasesPerSample;
                double value = Sinc(distance * cutoff) * Kaiser(distance / halfWidth);
                kernel[index] = (float)value;
                sum += index == 0 ? value : 2.0 * value;
            }
            float unity = (float)(PhasesPerSample / sum);
            for (int index = 0; index < kernel.Length; ++index)
            {
                kernel[index] *= unity;
            }
        }

        /// <summary>Wave samples per device sample.</summary>
        public double Step { get; }

        /// <summary>Wave samples after a position that reading it needs.</summary>
        public int LookAhead => halfWidth;

        /// <summary>Delay of the filter, in s.</summary>
        public double DelaySeconds => halfWidth / WaveHistory.RateHz;

        /// <summary>The filtered wave at a position, in wave samples.</summary>
        public float SampleAt(WaveHistory wave, double position)
        {
            long first = (long)Math.Ceiling(position - halfWidth);
            long last = (long)Math.Floor(position + halfWidth);
            double sum = 0.0;
            for (long place = first; place <= last; ++place)
            {
                double phase = Math.Abs(place - position) * PhasesPerSample;
                int index = (int)phase;
                double between = phase - index;
                sum += wave[place] * (kernel[index] + between * (kernel[index + 1] - kernel[index]));
            }
            return (float)sum;
        }

        private static double Sinc(double turns) =>
            turns == 0.0 ? 1.0 : Math.Sin(Math.PI * turns) / (Math.PI * turns);

        private static double Kaiser(double share) =>
            share >= 1.0 ? 0.0 : Bessel(KaiserBeta * Math.Sqrt(1.0 - share * share)) / Bessel(KaiserBeta);

        /// <summary>The modified Bessel function of the first kind and order 0, by its power series.</summary>
        private static double Bessel(double x)
        {
            double sum = 1.0;
            double term = 1.0;
            for (int index = 1; index < 32; ++index)
            {
                term *= x / (2.0 * index) * (x / (2.0 * index));
                sum += term;
            }
            return sum;
        }
    }
}
