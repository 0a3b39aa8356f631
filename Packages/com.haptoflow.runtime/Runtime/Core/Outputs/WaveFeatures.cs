#nullable enable
using System;
using HaptoFlow.Native;

namespace HaptoFlow.Outputs
{
    /// <summary>Perceptual features of a stretch of the wave.</summary>
    public readonly struct WaveFrame
    {
        /// <param name="amplitude">See <see cref="Amplitude"/>.</param>
        /// <param name="frequencyHz">See <see cref="FrequencyHz"/>.</param>
        /// <param name="transient">See <see cref="Transient"/>.</param>
        /// <param name="transientFrequencyHz">See <see cref="TransientFrequencyHz"/>.</param>
        /// <param name="transientOffsetSeconds">See <see cref="TransientOffsetSeconds"/>.</param>
        public WaveFrame(float amplitude, float frequencyHz, float transient, float transientFrequencyHz,
            float transientOffsetSeconds)
        {
            Amplitude = amplitude;
            FrequencyHz = frequencyHz;
            Transient = transient;
            TransientFrequencyHz = transientFrequencyHz;
            TransientOffsetSeconds = transientOffsetSeconds;
        }

        /// <summary>Amplitude of the vibration at <see cref="FrequencyHz"/> that feels equally strong, relative to full
        /// scale.</summary>
        public float Amplitude { get; }

        /// <summary>Mean frequency of what is felt, mapped to the device's range, in Hz.</summary>
        public float FrequencyHz { get; }

        /// <summary>Amplitude of the vibration at <see cref="TransientFrequencyHz"/> that feels as strong as a
        /// transient within the stretch, relative to full scale; 0 for none.</summary>
        public float Transient { get; }

        /// <summary>Frequency of the transient, within the device's range, in Hz.</summary>
        public float TransientFrequencyHz { get; }

        /// <summary>Time from the beginning of the stretch to the transient, in s.</summary>
        public float TransientOffsetSeconds { get; }
    }

    /// <summary>Computes frames of amplitude, frequency and transients from a wave, each of the same perceived
    /// intensity as the wave. One thread at a time; no garbage after construction.</summary>
    public sealed unsafe class WaveFeatures : IDisposable
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

        /// <summary>Discards the state before a new wave.</summary>
        public void Reset() => handle.Check(NativeMethods.WaveFeaturesReset(handle.Value));

        /// <summary>Sets the device's frequency range from the next frame on, above 0 to 1000 Hz; equal limits for a
        /// motor of one frequency.</summary>
        public void SetRange(double minimumHz, double maximumHz) =>
            handle.Check(NativeMethods.WaveFeaturesSetRange(handle.Value, minimumHz, maximumHz));

        /// <summary>Processes samples and writes the frames that they complete.</summary>
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
                NativeWaveFrame frame = frames[index];
                into[index] = new WaveFrame(frame.AmplitudeMps2 / FullScaleMps2, frame.FrequencyHz,
                    frame.TransientAmplitudeMps2 / FullScaleMps2, frame.TransientFrequencyHz,
                    frame.TransientOffsetSeconds);
            }
            return (int)count;
        }

        /// <inheritdoc/>
        public void Dispose() => handle.Dispose();
    }
}
