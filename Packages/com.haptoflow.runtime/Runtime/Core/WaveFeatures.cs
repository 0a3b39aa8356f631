#nullable enable
using System;
using HaptoFlow.Native;

namespace HaptoFlow.Outputs
{
    /// <summary>Perceptual features of a stretch of the wave.</summary>
    internal readonly struct WaveFrame
    {
        /// <summary>Amplitude of the vibration at <see cref="FrequencyHz"/> that feels equally strong, relative to full
        /// scale.</summary>
        public readonly float Amplitude;

        /// <summary>Mean frequency of what is felt, mapped to the device's range.</summary>
        public readonly float FrequencyHz;

        /// <summary>Amplitude of the vibration at <see cref="TransientFrequencyHz"/> that feels as strong as a
        /// transient within the stretch, relative to full scale; 0 for none.</summary>
        public readonly float Transient;

        /// <summary>Frequency of the transient, within the device's range.</summary>
        public readonly float TransientFrequencyHz;

        /// <summary>Time from the beginning of the stretch to the transient.</summary>
        public readonly float TransientOffsetSeconds;

        public WaveFrame(in NativeWaveFrame frame, float fullScaleMps2)
        {
            Amplitude = frame.AmplitudeMps2 / fullScaleMps2;
            FrequencyHz = frame.FrequencyHz;
            Transient = frame.TransientAmplitudeMps2 / fullScaleMps2;
            TransientFrequencyHz = frame.TransientFrequencyHz;
            TransientOffsetSeconds = frame.TransientOffsetSeconds;
        }
    }

    /// <summary>Computes frames of amplitude, frequency and transients from a wave, each of the same perceived
    /// intensity as the wave. One thread at a time; no garbage after construction.</summary>
    internal sealed unsafe class WaveFeatures : IDisposable
    {
        /// <summary>Time from the end of a frame until its features are known, in s, including the low-pass before
        /// it.</summary>
        public const double LatencySeconds = 0.0055;

        private readonly NativeHandle handle;
        private readonly NativeWaveFrame[] frames;
        private readonly float[] scaled;

        /// <param name="frameSeconds">Length of a frame, 0.002 to 0.032 s.</param>
        /// <param name="maximumSamples">Limit of samples in one call of <see cref="Process"/>.</param>
        /// <param name="rateHz">Rate of the wave: a multiple of 2000 up to 192000 Hz.</param>
        /// <exception cref="HaptoFlowException">Length or rate is out of range, or the library is missing.</exception>
        public WaveFeatures(double frameSeconds, int maximumSamples, int rateHz = (int)WaveHistory.RateHz)
        {
            frames = new NativeWaveFrame[(int)(maximumSamples / (rateHz * frameSeconds)) + 2];
            scaled = new float[maximumSamples];
            var options = new WaveFeaturesOptions
            {
                StructSize = (uint)sizeof(WaveFeaturesOptions),
                SampleRateHz = (uint)rateHz,
                FrameSeconds = frameSeconds,
            };
            LibraryAgreement.Require();
            IntPtr opened;
            NativeCall.Check(NativeMethods.WaveFeaturesCreate(&options, &opened));
            handle = new NativeHandle(opened, NativeMethods.WaveFeaturesClose);
        }

        /// <summary>Upper limit of frames that one call of <see cref="Process"/> completes.</summary>
        public int MaximumFrames => frames.Length;

        /// <summary>Full scale: the acceleration that a sample of 1 represents, in m/s^2. The features depend on
        /// it.</summary>
        public float FullScaleMps2 { get; set; } = (float)HapticEngineOptions.DefaultFullScaleMps2;

        public void Reset() => handle.Check(NativeMethods.WaveFeaturesReset(handle.Value));

        /// <summary>Sets the frequencies that the device can play, from the next frame on: above 0, at most 1000 Hz. Equal
        /// limits stand for a motor with a single frequency.</summary>
        public void SetRange(double minimumHz, double maximumHz) =>
            handle.Check(NativeMethods.WaveFeaturesSetRange(handle.Value, minimumHz, maximumHz));

        /// <summary>Takes the wave's next samples, and writes each frame whose last sample is among them.</summary>
        /// <param name="into">At least <see cref="MaximumFrames"/> long.</param>
        /// <returns>Number of frames written.</returns>
        public int Process(ReadOnlySpan<float> samples, Span<WaveFrame> into)
        {
            for (int index = 0; index < samples.Length; ++index)
            {
                scaled[index] = samples[index] * FullScaleMps2;
            }
            ulong count;
            fixed (float* wave = scaled)
            fixed (NativeWaveFrame* written = frames)
            {
                handle.Check(NativeMethods.WaveFeaturesProcess(
                    handle.Value, wave, (ulong)samples.Length, written, (ulong)frames.Length, &count));
            }
            for (int index = 0; index < (int)count; ++index)
            {
                into[index] = new WaveFrame(frames[index], FullScaleMps2);
            }
            return (int)count;
        }

        public void Dispose() => handle.Dispose();
    }

    /// <summary>Ring buffer of the newest samples of a wave, addressed by position. Voices render at this rate, the
    /// lowest that they support; <see cref="WaveDecimator"/> converts it to the device's.</summary>
    internal sealed class WaveHistory
    {
        public const double RateHz = 8000.0;

        private const int Size = 4096;
        private const int Mask = Size - 1;

        private readonly float[] samples = new float[Size];

        public long End { get; private set; }

        /// <summary>The sample at a position; 0 where it was never written or has been overwritten.</summary>
        public float this[long position] =>
            position >= 0 && position < End && position >= End - Size ? samples[position & Mask] : 0f;

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

        public float Peak(long from, long to)
        {
            float peak = 0f;
            for (long position = Math.Max(from, End - Size); position < Math.Min(to, End); ++position)
            {
                peak = Math.Max(peak, Math.Abs(samples[position & Mask]));
            }
            return peak;
        }

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
