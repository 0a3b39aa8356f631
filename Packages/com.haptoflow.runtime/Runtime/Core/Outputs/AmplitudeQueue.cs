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

        private const double DurationShare = 1.5;
        private const double DurationMarginSeconds = 0.01;

        private readonly IAmplitudeSink sink;
        private readonly IWaveFeatures features;
        private readonly float[] window = new float[(int)(LongestSeconds * WaveHistory.RateHz)];
        private double dueSeconds = double.NegativeInfinity;
        private double saidSeconds;
        private long analysed;

        public AmplitudeQueue(IAmplitudeSink sink, IWaveSource source, IWaveFeatures features)
            : base(sink, source)
        {
            this.sink = sink;
            this.features = features;
        }

        protected override void Prepare()
        {
            features.Reset();
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
            WaveFrame frame = features.Analyse(newest);
            float amplitude = Limited(Math.Max(frame.Amplitude, frame.Transient));
            if (amplitude <= Inaudible)
            {
                End();
                return;
            }
            double duration = Math.Min(LongestSeconds, DurationShare * expectedSeconds + DurationMarginSeconds);
            statistics.Gaps += IsPlaying && nowSeconds > saidSeconds ? 1 : 0;
            if (!sink.Submit(amplitude, frame.FrequencyHz, (float)duration))
            {
                LoseDevice();
                return;
            }
            ++statistics.Submissions;
            saidSeconds = nowSeconds + duration;
            IsPlaying = true;
            statistics.LatencyMilliseconds = 1000.0 * count / WaveHistory.RateHz;
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
