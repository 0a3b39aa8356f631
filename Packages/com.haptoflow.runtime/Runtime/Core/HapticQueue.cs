#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>Statistics of a queue since it was created. Fields are counts unless their name says
    /// otherwise.</summary>
    public struct HapticQueueStatistics
    {
        /// <summary>Time from rendering a sample to playing it, in ms, by the queue's clock and without the delays of
        /// device and radio; 0 while nothing plays.</summary>
        public double LatencyMilliseconds;

        /// <summary>Submissions to the device.</summary>
        public long Submissions;

        /// <summary>Number of times that the device had played everything before more arrived.</summary>
        public long Gaps;

        /// <summary>Number of times that the device was realigned with the queue's clock during playback.</summary>
        public long Alignments;

        /// <summary>Number of times that submitted samples were discarded: by a mute, a pause, a panic, or the end of
        /// the output.</summary>
        public long Stops;

        /// <summary>Number of times that the device disappeared or was replaced.</summary>
        public long DeviceChanges;

        /// <summary>Number of times that playback made way for another vibration of the device.</summary>
        public long Yields;

        /// <summary>The device's present rate, in Hz; 0 without one.</summary>
        public double RateHz;
    }

    /// <summary>Plays a wave on a device: each frame it renders as much as the device's clock requires. Main thread; no
    /// garbage except when the device changes.</summary>
    internal abstract class HapticQueue : IDisposable
    {
        // For motors that do not report their frequency: most eccentric masses and resonant actuators run near it.
        private const double DefaultMotorHz = 160.0;

        private const float LimiterKnee = 0.7f;

        private readonly IHapticSink sink;
        private bool hasDevice;
        private double beganSeconds = double.NaN;
        private float ceiling = 1f;
        private bool returns;

        // Fraction of a wave sample left over from the last frame.
        private double sampleFraction;
        private protected HapticQueueStatistics statistics;

        protected HapticQueue(IHapticSink sink, IWaveSource source) => (this.sink, Source) = (sink, source);

        public static HapticQueue For(HapticForm form, IHapticSink sink, IWaveSource source, bool mayReplace = true) =>
            form switch
            {
                HapticForm.Waveform => new WaveformQueue((IWaveformSink)sink, source, mayReplace),
                HapticForm.Parametric => new ParametricQueue((IParametricSink)sink, source),
                _ => new AmplitudeQueue((IAmplitudeSink)sink, source),
            };

        /// <summary>Gain on what is sent. With <see cref="TrueLevel"/> it is the ratio of the wave's full scale to the
        /// device's; otherwise it makes a device stronger or weaker than its loudness law. Changes take effect with the
        /// next submissions.</summary>
        public float Gain { get; set; } = 1f;

        /// <summary>True for an amplitude in proportion to the acceleration; false for the loudness law of the device's
        /// kind. Changes take effect with the next submissions.</summary>
        public virtual bool TrueLevel { get; set; } = true;

        public float Ceiling { get => ceiling; set => ceiling = Math.Max(0f, Math.Min(1f, value)); }

        public virtual float FullScaleMps2 { get; set; } = (float)HapticEngineOptions.DefaultFullScaleMps2;

        /// <summary>Time of the clock of <see cref="Update"/> until which the device belongs to another vibration: nothing
        /// is sent to it, not even a stop, and what was sent ends by itself.</summary>
        public double YieldUntilSeconds { get; set; } = double.NegativeInfinity;

        /// <summary>True while samples are queued or playing on the device.</summary>
        public bool IsPlaying { get; private protected set; }

        public HapticQueueStatistics Statistics => statistics;

        protected IWaveSource Source { get; }

        protected WaveHistory Wave { get; } = new WaveHistory();

        protected FramePace Pace { get; } = new FramePace();

        protected HapticSinkCapabilities Capabilities { get; private set; }

        /// <summary>Call once a frame.</summary>
        /// <param name="nowSeconds">Time of a real-time clock that never runs backwards.</param>
        public void Update(double nowSeconds)
        {
            double elapsed = double.IsNaN(beganSeconds) ? 0.0 : Math.Max(0.0, nowSeconds - beganSeconds);
            beganSeconds = nowSeconds;
            Pace.Note(elapsed);
            if (!FindDevice())
            {
                return;
            }
            if (nowSeconds < YieldUntilSeconds)
            {
                Yield(elapsed);
                return;
            }
            if (Source.IsStopped)
            {
                Flush(nowSeconds);
                // Voices fade out only while rendered; these samples are discarded.
                RenderSilently(elapsed);
                return;
            }
            Advance(nowSeconds, elapsed);
            // Rendering may have detected a stop since the last frame.
            if (Source.IsStopped)
            {
                Flush(nowSeconds);
            }
        }

        /// <summary>Discards submitted samples; takes effect on the device with this call.</summary>
        public void Flush(double nowSeconds)
        {
            if (IsPlaying)
            {
                ++statistics.Stops;
                DiscardSubmitted(nowSeconds);
                Rest();
            }
        }

        /// <summary>Takes whether playback begins amid a vibration that made way, not with its onset.</summary>
        protected bool TakeReturn()
        {
            bool was = returns;
            returns = false;
            return was;
        }

        protected abstract void Advance(double nowSeconds, double elapsedSeconds);

        /// <summary>Called after each frame of the wave while the device belongs to another vibration.</summary>
        protected virtual void PassOver()
        {
        }

        /// <summary>Ends the present playback now.</summary>
        protected abstract void DiscardSubmitted(double nowSeconds);

        /// <summary>Called when the device is new or has changed.</summary>
        protected abstract void Prepare();

        public virtual void Dispose()
        {
        }

        /// <summary>Sets the device's frequency range, as far as it reports one.</summary>
        protected void SetRangeOf(WaveFeatures features)
        {
            bool isKnown = Capabilities.MinFrequencyHz > 0.0 &&
                Capabilities.MaxFrequencyHz >= Capabilities.MinFrequencyHz;
            features.SetRange(isKnown ? Capabilities.MinFrequencyHz : DefaultMotorHz,
                isKnown ? Math.Min(Capabilities.MaxFrequencyHz, 1000.0) : DefaultMotorHz);
        }

        protected void Rest()
        {
            IsPlaying = false;
            statistics.LatencyMilliseconds = 0.0;
        }

        /// <summary>Called after the device reported that it is gone.</summary>
        protected void LoseDevice()
        {
            if (hasDevice)
            {
                hasDevice = false;
                statistics.RateHz = 0.0;
                ++statistics.DeviceChanges;
            }
            Rest();
        }

        /// <summary>Renders a frame's length while nothing plays.</summary>
        /// <returns>The position of the first audible sample; -1 where all are silent.</returns>
        protected long RenderSilently(double elapsedSeconds)
        {
            long from = Wave.End;
            sampleFraction += Math.Min(elapsedSeconds, FramePace.HitchSeconds) * WaveHistory.RateHz;
            long whole = (long)sampleFraction;
            sampleFraction -= whole;
            Wave.RenderTo(from + whole, Source);
            for (long position = from; position < Wave.End; ++position)
            {
                if (Math.Abs(Wave[position]) > Inaudible)
                {
                    return position;
                }
            }
            return -1;
        }

        /// <summary>The sample for the device: with gain, and compressed below the ceiling rather than
        /// clipped.</summary>
        protected float Limited(float sample)
        {
            float magnitude = Math.Abs(sample) * Gain;
            float knee = LimiterKnee * ceiling;
            float room = ceiling - knee;
            if (magnitude > knee)
            {
                magnitude = room > 0f ? knee + room * (float)Math.Tanh((magnitude - knee) / room) : ceiling;
            }
            return Math.Sign(sample) * magnitude;
        }

        /// <summary>What a device of the form gets for an amplitude of the wave's features.</summary>
        protected float Sent(HapticForm form, float amplitude) =>
            Limited(TrueLevel ? amplitude : DeviceLoudness.Share(form, amplitude * FullScaleMps2));

        /// <summary>Smaller magnitudes cannot be felt; the device need not play them.</summary>
        protected const float Inaudible = 1e-5f;

        private void Yield(double elapsedSeconds)
        {
            if (IsPlaying)
            {
                ++statistics.Yields;
                Rest();
            }
            // The texture goes on, so that it returns where it is by then.
            returns = RenderSilently(elapsedSeconds) >= 0L;
            PassOver();
        }

        private bool FindDevice()
        {
            bool found = sink.TryGetCapabilities(out HapticSinkCapabilities now) && now.RateHz >= 0.0;
            if (!found)
            {
                LoseDevice();
                return false;
            }
            if (hasDevice && now.Equals(Capabilities))
            {
                return true;
            }
            if (hasDevice)
            {
                // The queued samples were meant for the other device.
                sink.Stop();
                ++statistics.DeviceChanges;
            }
            hasDevice = true;
            Capabilities = now;
            statistics.RateHz = now.RateHz;
            Rest();
            Prepare();
            return true;
        }
    }

    /// <summary>Computes how far the main thread must be ahead of a device: the longest of the recent frames plus a
    /// margin. Hitches are ignored, so that the latency stays bounded.</summary>
    internal sealed class FramePace
    {
        /// <summary>A longer frame is a hitch, in s.</summary>
        public const double HitchSeconds = 0.05;

        private const double MarginSeconds = 0.006;
        private const double DecayPerFrame = 0.02;

        /// <summary>Time that must be queued on the device after a submission, in s.</summary>
        public double DepthSeconds => MaximumSeconds + MarginSeconds;

        public static double MaximumDepthSeconds => HitchSeconds + MarginSeconds;

        public double MaximumSeconds { get; private set; } = 1.0 / HapticEngineOptions.DefaultUpdateRateHz;

        public void Note(double frameSeconds)
        {
            if (frameSeconds > HitchSeconds || !(frameSeconds > 0.0))
            {
                return;
            }
            MaximumSeconds = Math.Max(frameSeconds,
                MaximumSeconds + DecayPerFrame * (frameSeconds - MaximumSeconds));
        }
    }
}
