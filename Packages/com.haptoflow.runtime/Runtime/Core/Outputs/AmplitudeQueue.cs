#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>Drives a motor: one amplitude for what the wave did since the last one. Every amplitude ends by itself
    /// soon after the next one is due, so that a hitch is a gap.</summary>
    internal sealed class AmplitudeQueue : HapticQueue
    {
        /// <summary>The longest that a motor runs on by itself, in s.</summary>
        public const double LongestSeconds = 0.1;

        private const double FrameSeconds = 0.008;
        private const int MaximumSamples = (int)(LongestSeconds * WaveHistory.RateHz);
        private const double DurationShare = 1.5;
        private const double DurationMarginSeconds = 0.01;

        private readonly IAmplitudeSink sink;
        private readonly WaveFeatures features = new WaveFeatures(FrameSeconds, MaximumSamples);
        private readonly WaveFrame[] frames;
        private readonly float[] window = new float[MaximumSamples];
        private double dueSeconds = double.NegativeInfinity;
        private double saidSeconds;
        private long analysed;
        private float amplitude;
        private float frequencyHz;

        public AmplitudeQueue(IAmplitudeSink sink, IWaveSource source)
            : base(sink, source)
        {
            this.sink = sink;
            frames = new WaveFrame[features.MostFrames];
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

        protected override void CallBack(double nowSeconds) => sink.Stop();

        protected override void Advance(double nowSeconds, double elapsedSeconds)
        {
            Listen(elapsedSeconds);
            double interval = Capabilities.RateHz > 0.0 ? 1.0 / Capabilities.RateHz : 0.0;
            if (nowSeconds < dueSeconds)
            {
                return;
            }
            // On average no faster than the device; after a pause it owes nothing.
            dueSeconds = Math.Max(dueSeconds + interval, nowSeconds + 0.5 * interval);
            Say(nowSeconds, Math.Max(interval, Pace.LongestSeconds));
        }

        private void Say(double nowSeconds, double expectedSeconds)
        {
            int count = (int)Math.Min(Wave.End - analysed, window.Length);
            analysed = Wave.End;
            if (count == 0)
            {
                return;
            }
            Span<float> newest = window.AsSpan(0, count);
            Wave.CopyNewest(newest);
            Analyse(newest);
            float sent = Limited(amplitude);
            if (sent <= Inaudible)
            {
                End();
                return;
            }
            double duration = Math.Min(LongestSeconds, DurationShare * expectedSeconds + DurationMarginSeconds);
            statistics.Gaps += IsPlaying && nowSeconds > saidSeconds ? 1 : 0;
            if (!sink.Submit(sent, frequencyHz, (float)duration))
            {
                LoseDevice();
                return;
            }
            ++statistics.Submissions;
            saidSeconds = nowSeconds + duration;
            IsPlaying = true;
            statistics.LatencyMilliseconds =
                1000.0 * (count / WaveHistory.RateHz + FrameSeconds + WaveFeatures.LatencySeconds);
        }

        /// <summary>The mean of the frames that are new, or the knock in one of them; what holds where none is.</summary>
        private void Analyse(ReadOnlySpan<float> newest)
        {
            features.FullScaleMps2 = FullScaleMps2;
            int count = features.Process(newest, frames);
            if (count == 0)
            {
                return;
            }
            float sum = 0f;
            WaveFrame knock = default;
            for (int index = 0; index < count; ++index)
            {
                sum += frames[index].Amplitude;
                knock = frames[index].Transient > knock.Transient ? frames[index] : knock;
            }
            bool isKnock = knock.Transient > sum / count;
            amplitude = isKnock ? knock.Transient : sum / count;
            frequencyHz = isKnock ? knock.TransientFrequencyHz : frames[count - 1].FrequencyHz;
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
}
