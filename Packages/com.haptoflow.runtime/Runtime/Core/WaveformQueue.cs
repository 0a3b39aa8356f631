#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>Supplies a device that plays waveforms.</summary>
    /// <remarks>The device does not report how many samples are left, and its clock is independent. Where a submission
    /// can replace what plays without a gap, every frame sends the stretch from the sample playing now to the required
    /// depth, with a fade at its end: the device is realigned each time, and a late frame causes a fade. Where
    /// submissions queue, each frame appends what was played according to the clock, and the device is realigned before
    /// its drift can exceed the margin, in a quiet moment if possible; each submission ends at a small sample, since a
    /// late frame cuts there.</remarks>
    internal sealed class WaveformQueue : HapticQueue
    {
        /// <summary>Duration of the fade at the end of a stretch, in s.</summary>
        public const double FadeSeconds = 0.003;

        private const double EntrySeconds = 0.002;

        // Upper limit of the relative error of a controller's clock.
        private const double MaximumDrift = 0.006;
        private const double MinimumUncertaintySeconds = 0.001;
        private const double MaximumUncertaintySeconds = 0.003;
        private const double QuietSeconds = 0.004;
        private const float QuietShare = 0.2f;
        private const double SearchForSmallSeconds = 0.0025;

        private readonly IWaveformSink sink;
        private readonly bool replaces;
        private readonly DeviceWave wave;
        private WaveDecimator decimator = new WaveDecimator(2000.0);
        private double preparedRateHz = 2000.0;
        private float[] buffer = Array.Empty<float>();

        // Playing position at the start of the newest stretch, in wave samples; its start time and its duration.
        private double position;
        private double anchorSeconds;
        private double stretchSeconds;
        private float entryGain;

        // Queuing: device samples submitted since the anchor.
        private long sent;

        /// <param name="mayReplace">False to queue submissions even where the device can replace them.</param>
        public WaveformQueue(IWaveformSink sink, IWaveSource source, bool mayReplace = true)
            : this(sink, new DeviceWave(source) { KeepsTrueLevel = true }, mayReplace)
        {
        }

        private WaveformQueue(IWaveformSink sink, DeviceWave wave, bool mayReplace)
            : base(sink, wave)
        {
            this.sink = sink;
            this.wave = wave;
            replaces = mayReplace && sink.ReplacesWithoutGap;
        }

        public override bool TrueLevel { get => wave.KeepsTrueLevel; set => wave.KeepsTrueLevel = value; }

        public override float FullScaleMps2 { get => wave.FullScaleMps2; set => wave.FullScaleMps2 = value; }

        public override void Dispose() => wave.Dispose();

        private double RateHz => Capabilities.RateHz;

        protected override void Prepare()
        {
            double longest = FramePace.MaximumDepthSeconds + FadeSeconds;
            int samples = (int)Math.Ceiling(longest * RateHz) + 3;
            samples = Math.Max(1, Math.Min(samples, Capabilities.MaximumSamples));
            // Reuses the buffers, so that a device that comes and goes makes no garbage.
            if (preparedRateHz != RateHz)
            {
                preparedRateHz = RateHz;
                decimator = new WaveDecimator(RateHz);
            }
            if (buffer.Length != samples)
            {
                buffer = new float[samples];
            }
        }

        protected override void Advance(double nowSeconds, double elapsedSeconds)
        {
            if (!IsPlaying && !Begin(nowSeconds, elapsedSeconds))
            {
                return;
            }
            if (replaces)
            {
                Replace(nowSeconds);
            }
            else
            {
                Append(nowSeconds);
            }
        }

        protected override void DiscardSubmitted(double nowSeconds)
        {
            if (!replaces)
            {
                sink.Stop();
                return;
            }
            if (MoveTo(nowSeconds))
            {
                return;
            }
            int fade = Math.Min(buffer.Length, FadeSamples + 1);
            Fill(fade, fade, 0L);
            if (sink.Submit(buffer.AsSpan(0, fade), true) < 0)
            {
                LoseDevice();
            }
        }

        private int FadeSamples => Math.Max(1, (int)Math.Round(FadeSeconds * RateHz));

        private bool Begin(double nowSeconds, double elapsedSeconds)
        {
            long first = RenderSilently(elapsedSeconds);
            bool returns = TakeReturn();
            if (first < 0)
            {
                return false;
            }
            // The filter's input before the first sample is silence, so starting costs no delay.
            SetAnchor(nowSeconds, first);
            entryGain = returns ? 0f : 1f;
            stretchSeconds = 0.0;
            IsPlaying = true;
            return true;
        }

        private void SetAnchor(double nowSeconds, double felt)
        {
            anchorSeconds = nowSeconds;
            position = felt;
            sent = 0L;
        }

        private void Replace(double nowSeconds)
        {
            if (stretchSeconds > 0.0)
            {
                statistics.Gaps += MoveTo(nowSeconds) ? 1 : 0;
                ++statistics.Alignments;
            }
            int count = Math.Min(buffer.Length, (int)Math.Ceiling(Pace.DepthSeconds * RateHz) + 1);
            RenderFor(count);
            if (Wave.Peak((long)position - decimator.LookAhead, Wave.End) <= Inaudible)
            {
                Rest();
                return;
            }
            Fill(count, FadeSamples, 0L);
            if (Submit(count, true))
            {
                stretchSeconds = count / RateHz;
                NoteLatency(stretchSeconds);
            }
        }

        /// <returns>True where the device has played everything.</returns>
        private bool MoveTo(double nowSeconds)
        {
            double since = nowSeconds - anchorSeconds;
            double left = stretchSeconds - since;
            double gain = Math.Min(entryGain + since / EntrySeconds, left / FadeSeconds);
            entryGain = (float)Math.Max(0.0, Math.Min(1.0, gain));
            bool ranDry = left <= 0.0;
            SetAnchor(nowSeconds, ranDry ? Wave.End - decimator.LookAhead : position + since * WaveHistory.RateHz);
            return ranDry;
        }

        private void Append(double nowSeconds)
        {
            double since = nowSeconds - anchorSeconds;
            double depth = sent / RateHz - since;
            bool replace = sent == 0L;
            if (!replace && depth <= 0.0)
            {
                ++statistics.Gaps;
                entryGain = 0f;
                SetAnchor(nowSeconds, Wave.End - decimator.LookAhead);
                replace = true;
            }
            else if (!replace && MustAlign(since))
            {
                ++statistics.Alignments;
                entryGain = 1f;
                SetAnchor(nowSeconds, position + since * WaveHistory.RateHz);
                replace = true;
            }
            double have = replace ? 0.0 : depth;
            int count = Math.Min(buffer.Length, (int)Math.Ceiling((Pace.DepthSeconds - have) * RateHz));
            if (count <= 0)
            {
                return;
            }
            RenderFor(sent + count);
            if (Wave.Peak((long)(position + (sent - 1) * decimator.Step) - decimator.LookAhead, Wave.End) <= Inaudible)
            {
                // The samples already submitted end in silence.
                Rest();
                return;
            }
            Fill(count, 0, sent);
            count = SmallEnd(count);
            if (Submit(count, replace))
            {
                NoteLatency(sent / RateHz - (nowSeconds - anchorSeconds));
            }
        }

        private bool MustAlign(double sinceSeconds)
        {
            double uncertainty = MaximumDrift * sinceSeconds;
            if (uncertainty < MinimumUncertaintySeconds)
            {
                return false;
            }
            if (uncertainty >= MaximumUncertaintySeconds)
            {
                return true;
            }
            long felt = (long)(position + sinceSeconds * WaveHistory.RateHz);
            long around = (long)(QuietSeconds * WaveHistory.RateHz);
            float recent = Wave.Peak(felt - 50L * around, Wave.End);
            return Wave.Peak(felt - around, felt + around) <= QuietShare * recent;
        }

        /// <summary>Renders the wave for a number of device samples after the anchor.</summary>
        private void RenderFor(long deviceSamples) => Wave.RenderTo(
            (long)Math.Ceiling(position + deviceSamples * decimator.Step) + decimator.LookAhead + 1L, Source);

        private void Fill(int count, int fade, long first)
        {
            double entry = Math.Max(1.0, EntrySeconds * RateHz);
            for (int index = 0; index < count; ++index)
            {
                long place = first + index;
                double gain = Math.Min(1.0, entryGain + place / entry);
                int toEnd = count - 1 - index;
                if (toEnd < fade)
                {
                    gain *= (double)toEnd / fade;
                }
                float sample = decimator.SampleAt(Wave, position + place * decimator.Step);
                buffer[index] = (float)gain * Limited(sample);
            }
        }

        /// <summary>Shortens a submission so that it ends at a small sample.</summary>
        private int SmallEnd(int count)
        {
            int end = count;
            int search = Math.Min(count - 1, (int)(SearchForSmallSeconds * RateHz));
            for (int candidate = count; candidate > count - search; --candidate)
            {
                if (Math.Abs(buffer[candidate - 1]) < Math.Abs(buffer[end - 1]))
                {
                    end = candidate;
                }
            }
            return end;
        }

        private bool Submit(int count, bool replace)
        {
            int taken = sink.Submit(buffer.AsSpan(0, count), replace);
            if (taken < 0)
            {
                LoseDevice();
                return false;
            }
            ++statistics.Submissions;
            sent += Math.Min(taken, count);
            return true;
        }

        private void NoteLatency(double depthSeconds) =>
            statistics.LatencyMilliseconds = 1000.0 *
            (depthSeconds + decimator.DelaySeconds + (TrueLevel ? 0.0 : DeviceWave.LatencySeconds));
    }
}
