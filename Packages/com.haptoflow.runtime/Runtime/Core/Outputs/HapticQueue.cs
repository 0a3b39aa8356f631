#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>What a queue did since it was made. Counts unless the name says otherwise.</summary>
    public struct HapticQueueStatistics
    {
        /// <summary>From a sample's rendering to its being felt, by the queue's own clock and without what device and
        /// radio add, in ms; 0 while nothing plays.</summary>
        public double LatencyMilliseconds;

        /// <summary>Calls that brought something to the device.</summary>
        public long Submissions;

        /// <summary>How often the device had played everything before more came.</summary>
        public long Gaps;

        /// <summary>How often the device was set to the queue's clock while it played.</summary>
        public long Alignments;

        /// <summary>How often something on its way was called back: by a mute, a pause, a panic, or the end of the
        /// output.</summary>
        public long Stops;

        /// <summary>How often the device vanished, or came back as another.</summary>
        public long DeviceChanges;

        /// <summary>The device's rate at present, in Hz; 0 where there is none.</summary>
        public double RateHz;
    }

    /// <summary>Brings a wave to a device: renders as much of it as the device's clock asks for, once a frame. Main
    /// thread; no garbage but where the device changes.</summary>
    internal abstract class HapticQueue : IDisposable
    {
        // Of a motor of which nothing is known: most eccentric masses and resonant actuators run near it.
        private const double UsualMotorHz = 160.0;

        private const float LimiterKnee = 0.7f;

        private readonly IHapticSink sink;
        private HapticSinkCapabilities capabilities;
        private bool hasDevice;
        private double beganSeconds = double.NaN;
        private float ceiling = 1f;

        // What is left of the last frame's length: less than one sample of the wave.
        private double unheard;
        private protected HapticQueueStatistics statistics;

        protected HapticQueue(IHapticSink sink, IWaveSource source)
        {
            this.sink = sink;
            Source = source;
        }

        /// <summary>What makes the wave's full scale the device's: 1 or more for a device that is weaker. Glides with the
        /// submissions.</summary>
        public float Gain { get; set; } = 1f;

        /// <summary>The largest magnitude that is sent, 0 to 1.</summary>
        public float Ceiling
        {
            get => ceiling;
            set => ceiling = Math.Max(0f, Math.Min(1f, value));
        }

        /// <summary>The acceleration that a sample of 1 stands for, in m/s^2.</summary>
        public float FullScaleMps2 { get; set; } = (float)HapticEngineOptions.DefaultFullScaleMps2;

        /// <summary>Something is on its way to the device, or plays there.</summary>
        public bool IsPlaying { get; private protected set; }

        public HapticQueueStatistics Statistics => statistics;

        protected IWaveSource Source { get; }

        protected WaveHistory Wave { get; } = new WaveHistory();

        protected FramePace Pace { get; } = new FramePace();

        protected HapticSinkCapabilities Capabilities => capabilities;

        /// <summary>Once a frame.</summary>
        /// <param name="nowSeconds">Of a clock that goes on while a frame takes long; never backwards.</param>
        public void Update(double nowSeconds)
        {
            double elapsed = double.IsNaN(beganSeconds) ? 0.0 : Math.Max(0.0, nowSeconds - beganSeconds);
            beganSeconds = nowSeconds;
            Pace.Note(elapsed);
            if (!FindDevice())
            {
                return;
            }
            if (Source.IsStopped)
            {
                Flush(nowSeconds);
                // The voice closes what it silences while it is rendered; nobody feels it.
                Listen(elapsed);
                return;
            }
            Advance(nowSeconds, elapsed);
            // What was stopped since the last frame shows in what was rendered now.
            if (Source.IsStopped)
            {
                Flush(nowSeconds);
            }
        }

        /// <summary>Calls back what is on its way: reaches the device with this call.</summary>
        /// <param name="nowSeconds">Of the same clock as <see cref="Update"/>'s.</param>
        public void Flush(double nowSeconds)
        {
            if (IsPlaying)
            {
                ++statistics.Stops;
                CallBack(nowSeconds);
                Rest();
            }
        }

        /// <summary>Moves wave and device on by a frame.</summary>
        protected abstract void Advance(double nowSeconds, double elapsedSeconds);

        /// <summary>Something plays and must end now.</summary>
        protected abstract void CallBack(double nowSeconds);

        /// <summary>The device is a new one, or changed.</summary>
        protected abstract void Prepare();

        /// <inheritdoc/>
        public virtual void Dispose()
        {
        }

        /// <summary>What the device can play, as far as it says so.</summary>
        protected void SetRangeOf(WaveFeatures features)
        {
            bool isKnown = Capabilities.MinFrequencyHz > 0.0 &&
                Capabilities.MaxFrequencyHz >= Capabilities.MinFrequencyHz;
            features.SetRange(isKnown ? Capabilities.MinFrequencyHz : UsualMotorHz,
                isKnown ? Math.Min(Capabilities.MaxFrequencyHz, 1000.0) : UsualMotorHz);
        }

        protected void Rest()
        {
            IsPlaying = false;
            statistics.LatencyMilliseconds = 0.0;
        }

        /// <summary>The device said that it is gone.</summary>
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
        /// <returns>The position from which on something can be felt; -1 where all is silent.</returns>
        protected long Listen(double elapsedSeconds)
        {
            long from = Wave.End;
            unheard += Math.Min(elapsedSeconds, FramePace.HitchSeconds) * WaveHistory.RateHz;
            long whole = (long)unheard;
            unheard -= whole;
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

        /// <summary>What the device gets for a sample of the wave: bent before the ceiling rather than cut.</summary>
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

        /// <summary>Below this nothing is felt: a device need not be kept busy with it.</summary>
        protected const float Inaudible = 1e-5f;

        private bool FindDevice()
        {
            bool found = sink.TryGetCapabilities(out HapticSinkCapabilities now) && now.RateHz >= 0.0;
            if (!found)
            {
                LoseDevice();
                return false;
            }
            if (hasDevice && now.Equals(capabilities))
            {
                return true;
            }
            if (hasDevice)
            {
                // What was on its way was made for another device.
                sink.Stop();
                ++statistics.DeviceChanges;
            }
            hasDevice = true;
            capabilities = now;
            statistics.RateHz = now.RateHz;
            Rest();
            Prepare();
            return true;
        }
    }
}
