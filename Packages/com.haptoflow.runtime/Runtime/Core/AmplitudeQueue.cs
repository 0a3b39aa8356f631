#nullable enable
using System;
using HaptoFlow.Native;

namespace HaptoFlow.Outputs
{
    /// <summary>Drives a motor with one amplitude for the stretch of the wave since the last one. Each amplitude ends
    /// by itself soon after the next one is due, so a late frame causes a gap, not an endless vibration.</summary>
    internal sealed class AmplitudeQueue : HapticQueue
    {
        /// <summary>Longest duration of one amplitude, in s.</summary>
        public const double MaximumSeconds = 0.1;

        private const double FrameSeconds = 0.008;
        private const int MaximumSamples = (int)(MaximumSeconds * WaveHistory.RateHz);
        private const double DurationShare = 1.5;
        private const double DurationMarginSeconds = 0.01;

        private readonly IAmplitudeSink sink;
        private readonly WaveFeatures features = new WaveFeatures(FrameSeconds, MaximumSamples);
        private readonly WaveFrame[] frames;
        private readonly float[] window = new float[MaximumSamples];
        private double dueSeconds = double.NegativeInfinity;
        private double submittedUntilSeconds;
        private long analysed;
        private float amplitude;
        private float frequencyHz;

        public AmplitudeQueue(IAmplitudeSink sink, IWaveSource source)
            : base(sink, source)
        {
            this.sink = sink;
            frames = new WaveFrame[features.MaximumFrames];
        }

        public override void Dispose() => features.Dispose();

        protected override void Prepare()
        {
            features.Reset();
            SetRangeOf(features);
            amplitude = 0f;
            dueSeconds = double.NegativeInfinity;
            analysed = Wave.End;
        }

        protected override void DiscardSubmitted(double nowSeconds) => sink.Stop();

        protected override void Advance(double nowSeconds, double elapsedSeconds)
        {
            RenderSilently(elapsedSeconds);
            double interval = Capabilities.RateHz > 0.0 ? 1.0 / Capabilities.RateHz : 0.0;
            if (nowSeconds < dueSeconds)
            {
                return;
            }
            // Keeps the average rate at the device's limit; after a pause nothing is made up for.
            dueSeconds = Math.Max(dueSeconds + interval, nowSeconds + 0.5 * interval);
            SubmitAmplitude(nowSeconds, Math.Max(interval, Pace.MaximumSeconds));
        }

        // What happened meanwhile, such as an impact, must not be felt afterwards.
        protected override void PassOver() => AnalyseNewest();

        private void SubmitAmplitude(double nowSeconds, double expectedSeconds)
        {
            int count = AnalyseNewest();
            if (count == 0)
            {
                return;
            }
            float sent = Sent(HapticForm.Amplitude, amplitude);
            if (Math.Min(sent, amplitude) <= Inaudible)
            {
                End();
                return;
            }
            double duration = Math.Min(MaximumSeconds, DurationShare * expectedSeconds + DurationMarginSeconds);
            statistics.Gaps += IsPlaying && nowSeconds > submittedUntilSeconds ? 1 : 0;
            if (!sink.Submit(sent, frequencyHz, (float)duration))
            {
                LoseDevice();
                return;
            }
            ++statistics.Submissions;
            submittedUntilSeconds = nowSeconds + duration;
            IsPlaying = true;
            statistics.LatencyMilliseconds =
                1000.0 * (count / WaveHistory.RateHz + FrameSeconds + WaveFeatures.LatencySeconds);
        }

        /// <summary>Analyses the wave since the last call, up to the length of the window.</summary>
        /// <returns>The number of samples.</returns>
        private int AnalyseNewest()
        {
            int count = (int)Math.Min(Wave.End - analysed, window.Length);
            analysed = Wave.End;
            if (count > 0)
            {
                Span<float> newest = window.AsSpan(0, count);
                Wave.CopyNewest(newest);
                Analyse(newest);
            }
            return count;
        }

        /// <summary>Computes amplitude and frequency: the mean of the new frames, or the strongest transient among
        /// them; unchanged without a new frame.</summary>
        private void Analyse(ReadOnlySpan<float> newest)
        {
            features.FullScaleMps2 = FullScaleMps2;
            int count = features.Process(newest, frames);
            if (count == 0)
            {
                return;
            }
            float sum = 0f;
            WaveFrame transient = default;
            for (int index = 0; index < count; ++index)
            {
                sum += frames[index].Amplitude;
                transient = frames[index].Transient > transient.Transient ? frames[index] : transient;
            }
            bool isTransient = transient.Transient > sum / count;
            amplitude = isTransient ? transient.Transient : sum / count;
            frequencyHz = isTransient ? transient.TransientFrequencyHz : frames[count - 1].FrequencyHz;
        }

        private void End()
        {
            if (IsPlaying)
            {
                sink.Stop();
                Rest();
            }
        }
    }

    /// <summary>The loudness law of the native library: the part of a device's range at which an acceleration is
    /// played. Straight proportion would leave most textures where a motor does not move.</summary>
    internal static unsafe class DeviceLoudness
    {
        /// <summary>The part of the device's range, 0 to below 1, of a peak amplitude in m/s^2.</summary>
        public static float Share(HapticForm form, float amplitudeMps2)
        {
            float share;
            NativeCall.Check(NativeMethods.DeviceShare((int)form, amplitudeMps2, &share));
            return share;
        }
    }

    /// <summary>A source's wave at the level of a device that plays waveforms, by a gain that follows the wave's
    /// envelope. Main thread; no garbage.</summary>
    internal sealed unsafe class DeviceWave : IWaveSource, IDisposable
    {
        /// <summary>Delay of the wave, in s.</summary>
        public const double LatencySeconds = 0.001;

        private readonly IWaveSource source;
        private readonly NativeHandle handle;
        private bool keepsTrueLevel;

        public DeviceWave(IWaveSource source)
        {
            this.source = source;
            IntPtr opened;
            NativeCall.Check(NativeMethods.DeviceWaveCreate(WaveHistory.RateHz, &opened));
            handle = new NativeHandle(opened, NativeMethods.DeviceWaveClose);
        }

        /// <summary>True to pass the wave on as it is.</summary>
        public bool KeepsTrueLevel
        {
            get => keepsTrueLevel;
            set
            {
                if (value != keepsTrueLevel)
                {
                    keepsTrueLevel = value;
                    handle.Check(NativeMethods.DeviceWaveReset(handle.Value));
                }
            }
        }

        public float FullScaleMps2 { get; set; } = (float)HapticEngineOptions.DefaultFullScaleMps2;

        public bool IsStopped => source.IsStopped;

        public void Render(Span<float> samples)
        {
            source.Render(samples);
            if (keepsTrueLevel)
            {
                return;
            }
            fixed (float* wave = samples)
            {
                handle.Check(NativeMethods.DeviceWaveProcess(
                    handle.Value, wave, (ulong)samples.Length, FullScaleMps2));
            }
        }

        public void Dispose() => handle.Dispose();
    }
}
