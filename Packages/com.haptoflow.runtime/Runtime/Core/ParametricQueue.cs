#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>Streams amplitude, frequency and transients ahead of the device's playback. The stream restarts before
    /// the drift of the device's clock can exceed the margin, and from silence after a hitch.</summary>
    internal sealed class ParametricQueue : HapticQueue
    {
        /// <summary>Interval between points, in s.</summary>
        public const double PointSeconds = 0.005;

        private const double MaximumDrift = 0.006;
        private const double MaximumUncertaintySeconds = 0.003;
        private const int PointSamples = (int)(PointSeconds * WaveHistory.RateHz);

        // Points of one submission; twice as many are kept for a restart of the stream.
        private const int MaximumPoints = 64;

        private readonly IParametricSink sink;
        private readonly WaveFeatures features = new WaveFeatures(PointSeconds, PointSamples);
        private readonly float[] stretch = new float[PointSamples];
        private readonly ParametricPoint[] amplitudes = new ParametricPoint[MaximumPoints + 1];
        private readonly ParametricPoint[] frequencies = new ParametricPoint[MaximumPoints + 1];
        private readonly ParametricTransient[] transients = new ParametricTransient[MaximumPoints + 1];
        private readonly WaveFrame[] frames = new WaveFrame[2 * MaximumPoints];
        private readonly WaveFrame[] completed;

        // Point n is at the end of stretch n - 1 of the wave, counted from its origin.
        private long origin;
        private long made;
        private long analysedSamples;
        private long anchorPoint;
        private double anchorSeconds;
        private long sentPoint;
        private double dueSeconds;

        public ParametricQueue(IParametricSink sink, IWaveSource source)
            : base(sink, source)
        {
            this.sink = sink;
            completed = new WaveFrame[features.MaximumFrames];
        }

        public override void Dispose() => features.Dispose();

        protected override void Prepare() => SetRangeOf(features);

        protected override void DiscardSubmitted(double nowSeconds) => sink.Stop();

        protected override void Advance(double nowSeconds, double elapsedSeconds)
        {
            if (!IsPlaying)
            {
                BeginAtFirstAudibleSample(nowSeconds, elapsedSeconds);
                return;
            }
            double since = nowSeconds - anchorSeconds;
            if ((sentPoint - anchorPoint) * PointSeconds <= since)
            {
                ++statistics.Gaps;
                Begin(nowSeconds, sentPoint);
                Send(nowSeconds, true, 0f);
            }
            else if (MaximumDrift * since > MaximumUncertaintySeconds)
            {
                ++statistics.Alignments;
                Begin(nowSeconds, anchorPoint + (long)Math.Round(since / PointSeconds));
                Send(nowSeconds, true, Value(anchorPoint));
            }
            else if (nowSeconds >= dueSeconds)
            {
                Send(nowSeconds, false, 0f);
            }
        }

        private double IntervalSeconds => Capabilities.RateHz > 0.0 ? 1.0 / Capabilities.RateHz : 0.0;

        private void BeginAtFirstAudibleSample(double nowSeconds, double elapsedSeconds)
        {
            long first = RenderSilently(elapsedSeconds);
            if (first < 0)
            {
                return;
            }
            features.Reset();
            origin = first;
            made = 0L;
            analysedSamples = 0L;
            sentPoint = 0L;
            frames[0] = default;
            IsPlaying = true;
            Begin(nowSeconds, 0L);
            Send(nowSeconds, true, 0f);
        }

        private void Begin(double nowSeconds, long point)
        {
            anchorSeconds = nowSeconds;
            anchorPoint = point;
            dueSeconds = nowSeconds;
        }

        private void Send(double nowSeconds, bool starts, float entry)
        {
            double since = nowSeconds - anchorSeconds;
            double ahead = Pace.DepthSeconds + IntervalSeconds;
            if (starts)
            {
                ahead = Math.Max(ahead, Capabilities.MinimumDepthSeconds);
                sentPoint = anchorPoint;
            }
            long last = Math.Min(sentPoint + MaximumPoints,
                anchorPoint + (long)Math.Ceiling((since + ahead) / PointSeconds));
            if (last <= sentPoint)
            {
                return;
            }
            AnalyseUpTo(last);
            bool ends = !IsFelt(sentPoint, last);
            int count = 0;
            if (starts)
            {
                Set(count++, anchorPoint, entry);
            }
            int transientCount = 0;
            for (long point = sentPoint + 1L; point <= last; ++point)
            {
                Set(count++, point, ends ? 0f : Value(point));
                WaveFrame frame = frames[point % frames.Length];
                if (frame.Transient > 0f)
                {
                    transients[transientCount++] = new ParametricTransient(
                        (point - 1L - anchorPoint) * PointSeconds + frame.TransientOffsetSeconds,
                        Sent(HapticForm.Parametric, frame.Transient), Share(frame.TransientFrequencyHz));
                }
            }
            StreamPart part = starts ? StreamPart.First : ends ? StreamPart.Last : StreamPart.Intermediate;
            if (!sink.Submit(amplitudes.AsSpan(0, count), frequencies.AsSpan(0, count),
                transients.AsSpan(0, transientCount), part))
            {
                LoseDevice();
                return;
            }
            ++statistics.Submissions;
            sentPoint = last;
            dueSeconds = Math.Max(dueSeconds + IntervalSeconds, nowSeconds + 0.5 * IntervalSeconds);
            statistics.LatencyMilliseconds = 1000.0 *
                (WaveFeatures.LatencySeconds + (last - anchorPoint) * PointSeconds - (nowSeconds - anchorSeconds));
            if (part == StreamPart.Last)
            {
                Rest();
            }
        }

        private void AnalyseUpTo(long last)
        {
            features.FullScaleMps2 = FullScaleMps2;
            while (made < last)
            {
                Wave.RenderTo(Math.Max(Wave.End, origin + analysedSamples + PointSamples), Source);
                for (int index = 0; index < PointSamples; ++index)
                {
                    stretch[index] = Wave[origin + analysedSamples + index];
                }
                analysedSamples += PointSamples;
                int count = features.Process(stretch, completed);
                for (int index = 0; index < count; ++index)
                {
                    frames[++made % frames.Length] = completed[index];
                }
            }
        }

        private bool IsFelt(long behind, long last)
        {
            for (long point = behind; point <= last; ++point)
            {
                if (frames[point % frames.Length].Amplitude > Inaudible)
                {
                    return true;
                }
            }
            return false;
        }

        private void Set(int place, long point, float amplitude)
        {
            double seconds = (point - anchorPoint) * PointSeconds;
            amplitudes[place] = new ParametricPoint(seconds, amplitude);
            frequencies[place] = new ParametricPoint(seconds, Share(frames[point % frames.Length].FrequencyHz));
        }

        private float Value(long point) => Sent(HapticForm.Parametric, frames[point % frames.Length].Amplitude);

        private float Share(float frequencyHz)
        {
            double range = Capabilities.MaxFrequencyHz - Capabilities.MinFrequencyHz;
            double share = range > 0.0 ? (frequencyHz - Capabilities.MinFrequencyHz) / range : 0.5;
            return (float)Math.Max(0.0, Math.Min(1.0, share));
        }
    }
}
