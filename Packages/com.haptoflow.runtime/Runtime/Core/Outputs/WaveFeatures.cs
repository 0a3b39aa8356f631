#nullable enable
using System;
using HaptoFlow.Native;

namespace HaptoFlow.Outputs
{
    /// <summary>What a stretch of the wave feels like.</summary>
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

        /// <summary>Of the vibration at <see cref="FrequencyHz"/> that feels as strong, in full scales of the wave.
        /// </summary>
        public float Amplitude { get; }

        /// <summary>Where the energy is as the hand weighs it, within the device's range, in Hz.</summary>
        public float FrequencyHz { get; }

        /// <summary>Of a knock within the stretch: amplitude of the vibration at <see cref="TransientFrequencyHz"/> that
        /// feels as strong, in full scales of the wave; 0 for none.</summary>
        public float Transient { get; }

        /// <summary>The knock's own frequency, within the device's range, in Hz.</summary>
        public float TransientFrequencyHz { get; }

        /// <summary>From the beginning of the stretch to the knock, in s.</summary>
        public float TransientOffsetSeconds { get; }
    }

    /// <summary>Makes frames of amplitude, frequency and transients from a wave, each as intense to the hand as the wave
    /// was. Any one thread; no garbage after construction.</summary>
    public sealed unsafe class WaveFeatures : IDisposable
    {
        /// <summary>From the end of a frame until it is known, in s, with what the low-pass before it delays.</summary>
        public const double LatencySeconds = 0.0055;

        private readonly WaveFeaturesHandle handle;
        private readonly NativeWaveFrame[] frames;
        private readonly float[] scaled;

        /// <param name="frameSeconds">Length of a frame, 0.002 to 0.032 s.</param>
        /// <param name="maximumSamples">Of one call of <see cref="Process"/>.</param>
        /// <param name="rateHz">Of the wave: a multiple of 2000 up to 192000.</param>
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
            IntPtr opened;
            NativeCall.Check(NativeMethods.WaveFeaturesCreate(&options, &opened));
            handle = new WaveFeaturesHandle(opened);
        }

        /// <summary>The most frames that one call of <see cref="Process"/> can complete.</summary>
        public int MostFrames => frames.Length;

        /// <summary>The acceleration that a sample of 1 stands for, in m/s^2: what is felt depends on it.</summary>
        public float FullScaleMps2 { get; set; } = (float)HapticEngineOptions.DefaultFullScaleMps2;

        /// <summary>Forgets what came before: the wave begins anew.</summary>
        public void Reset()
        {
            NativeCall.Check(NativeMethods.WaveFeaturesReset(handle.Value));
            GC.KeepAlive(this);
        }

        /// <summary>What the device can play from the next frame on, above 0 to 1000 Hz; both the same for a motor of one
        /// frequency.</summary>
        public void SetRange(double minimumHz, double maximumHz)
        {
            NativeCall.Check(NativeMethods.WaveFeaturesSetRange(handle.Value, minimumHz, maximumHz));
            GC.KeepAlive(this);
        }

        /// <summary>Takes the next samples and writes the frames that they complete.</summary>
        /// <param name="into">Room for <see cref="MostFrames"/>.</param>
        /// <returns>How many frames.</returns>
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
                NativeCall.Check(NativeMethods.WaveFeaturesProcess(
                    handle.Value, wave, (ulong)samples.Length, written, (ulong)frames.Length, &count));
            }
            GC.KeepAlive(this);
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
