#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>The form in which a device accepts vibration, in order of increasing fidelity.</summary>
    public enum HapticForm
    {
        /// <summary>One amplitude at a time, for a motor.</summary>
        Amplitude = 0,

        /// <summary>Amplitude and frequency over time, and transients.</summary>
        Parametric = 1,

        /// <summary>The waveform itself.</summary>
        Waveform = 2,
    }

    /// <summary>The present capabilities of a device.</summary>
    public readonly struct HapticSinkCapabilities : IEquatable<HapticSinkCapabilities>
    {
        /// <summary>Each parameter is the property of its name.</summary>
        public HapticSinkCapabilities(double rateHz, int maximumSamples = int.MaxValue, double minFrequencyHz = 0.0,
            double maxFrequencyHz = 0.0, double minimumDepthSeconds = 0.0)
        {
            RateHz = rateHz;
            MaximumSamples = maximumSamples;
            MinFrequencyHz = minFrequencyHz;
            MaxFrequencyHz = maxFrequencyHz;
            MinimumDepthSeconds = minimumDepthSeconds;
        }

        /// <summary>Waveform: sample rate. Other forms: limit of submissions per second; 0 for one per frame.</summary>
        public double RateHz { get; }

        /// <summary>Waveform: limit of samples per submission.</summary>
        public int MaximumSamples { get; }

        /// <summary>Parametric: the frequency that the value 0 represents. Amplitude: the lower limit of the motor's
        /// range. In Hz; 0 where unknown, which is treated as a motor of 160 Hz.</summary>
        public double MinFrequencyHz { get; }

        /// <summary>Parametric: the frequency that the value 1 represents. Amplitude: the upper limit of the motor's
        /// range. In Hz.</summary>
        public double MaxFrequencyHz { get; }

        /// <summary>Minimum duration of the first submission, in s.</summary>
        public double MinimumDepthSeconds { get; }

        /// <inheritdoc/>
        public bool Equals(HapticSinkCapabilities other) =>
            RateHz.Equals(other.RateHz) && MaximumSamples == other.MaximumSamples &&
            MinFrequencyHz.Equals(other.MinFrequencyHz) && MaxFrequencyHz.Equals(other.MaxFrequencyHz) &&
            MinimumDepthSeconds.Equals(other.MinimumDepthSeconds);

        /// <inheritdoc/>
        public override bool Equals(object? other) => other is HapticSinkCapabilities same && Equals(same);

        /// <inheritdoc/>
        public override int GetHashCode() => HashCode.Combine(RateHz, MaximumSamples, MaxFrequencyHz);
    }

    /// <summary>A haptic device, as an output uses it. All calls on the main thread and without garbage.</summary>
    public interface IHapticSink
    {
        /// <summary>Name of the device, for messages.</summary>
        string Name { get; }

        /// <summary>The present capabilities. Called every frame: must be cheap and must not log.</summary>
        /// <returns>False while the device is absent or asleep.</returns>
        bool TryGetCapabilities(out HapticSinkCapabilities capabilities);

        /// <summary>Stops playback at once.</summary>
        void Stop();
    }

    /// <summary>A device that accepts waveforms.</summary>
    public interface IWaveformSink : IHapticSink
    {
        /// <summary>True where a submission can replace what plays without a gap. Otherwise submissions queue, and
        /// replacing is used rarely.</summary>
        bool ReplacesWithoutGap { get; }

        /// <param name="samples">Samples within +-1 at the device's rate.</param>
        /// <param name="replace">True to start at once and replace what plays; false to append.</param>
        /// <returns>Number of samples accepted; -1 where the device is gone.</returns>
        int Submit(ReadOnlySpan<float> samples, bool replace);
    }

    /// <summary>A value at a time of a stream.</summary>
    public readonly struct ParametricPoint
    {
        /// <summary>Each parameter is the property of its name.</summary>
        public ParametricPoint(double seconds, float value) => (Seconds, Value) = (seconds, value);

        /// <summary>Time from the start of the stream, in s.</summary>
        public double Seconds { get; }

        /// <summary>Value, 0 to 1.</summary>
        public float Value { get; }
    }

    /// <summary>A transient at a time of a stream.</summary>
    public readonly struct ParametricTransient
    {
        /// <summary>Each parameter is the property of its name.</summary>
        public ParametricTransient(double seconds, float amplitude, float frequency) =>
            (Seconds, Amplitude, Frequency) = (seconds, amplitude, frequency);

        /// <summary>Time from the start of the stream, in s.</summary>
        public double Seconds { get; }

        /// <summary>Amplitude, 0 to 1.</summary>
        public float Amplitude { get; }

        /// <summary>Frequency, 0 to 1 of the device's range.</summary>
        public float Frequency { get; }
    }

    /// <summary>Position of a submission in a stream.</summary>
    public enum StreamPart
    {
        /// <summary>Starts a stream that replaces what plays; its first points are at 0 s.</summary>
        First = 1,

        /// <summary>Continues after the last point sent.</summary>
        Intermediate = 2,

        /// <summary>Ends the stream with its last point.</summary>
        Last = 3,
    }

    /// <summary>A device that accepts amplitude and frequency over time.</summary>
    public interface IParametricSink : IHapticSink
    {
        /// <summary>Submits points in rising order of time; no frequency or transient is later than the last
        /// amplitude.</summary>
        /// <returns>False where the device is gone.</returns>
        bool Submit(ReadOnlySpan<ParametricPoint> amplitudes, ReadOnlySpan<ParametricPoint> frequencies,
            ReadOnlySpan<ParametricTransient> transients, StreamPart part);
    }

    /// <summary>A device that accepts one amplitude at a time.</summary>
    public interface IAmplitudeSink : IHapticSink
    {
        /// <summary>Starts a vibration of limited duration that replaces what plays.</summary>
        /// <param name="amplitude">Amplitude, 0 to 1.</param>
        /// <param name="frequencyHz">The frequency of most of the wave's energy; devices of one frequency ignore
        /// it.</param>
        /// <param name="durationSeconds">Time after which the device stops unless another amplitude arrives.</param>
        /// <returns>False where the device is gone.</returns>
        bool Submit(float amplitude, float frequencyHz, float durationSeconds);
    }

    /// <summary>The source of a queue's wave. The queue drives its clock.</summary>
    internal interface IWaveSource
    {
        /// <summary>True during a mute, a pause, a strength of 0 or a panic: samples already submitted must be
        /// discarded.</summary>
        bool IsStopped { get; }

        /// <summary>Renders the next samples, within +-1, of a wave at <see cref="WaveHistory.RateHz"/>.</summary>
        void Render(Span<float> samples);
    }

    /// <summary>Decides when to repeat a call that failed: after a first delay, then after twice as long each time, up
    /// to a limit. One failure never ends a route, and a lasting one costs next to nothing.</summary>
    public sealed class RetryDelay
    {
        private readonly double firstSeconds;
        private readonly double maximumSeconds;
        private double delaySeconds;
        private double dueSeconds = double.NegativeInfinity;
        private bool hasFailed;

        /// <param name="firstSeconds">Delay after the first failure, in s, above 0.</param>
        /// <param name="maximumSeconds">Limit of the delay, in s.</param>
        public RetryDelay(double firstSeconds, double maximumSeconds) =>
            (this.firstSeconds, this.maximumSeconds) = (firstSeconds, maximumSeconds);

        /// <summary>True where the call may be made: it has not failed since a success, or the delay is over.</summary>
        /// <param name="nowSeconds">Time of a real-time clock, in s.</param>
        public bool IsDue(double nowSeconds) => nowSeconds >= dueSeconds;

        /// <summary>Call it after a failure.</summary>
        /// <param name="nowSeconds">Time of the clock of <see cref="IsDue"/>, in s.</param>
        /// <returns>True for the first failure since the last <see cref="Restart"/>, which should be logged.</returns>
        public bool Fail(double nowSeconds)
        {
            delaySeconds = delaySeconds > 0.0 ? Math.Min(2.0 * delaySeconds, maximumSeconds) : firstSeconds;
            dueSeconds = nowSeconds + delaySeconds;
            bool isFirst = !hasFailed;
            hasFailed = true;
            return isFirst;
        }

        /// <summary>Call it after a success, or when something changed that may have caused the failure.</summary>
        public void Forget()
        {
            delaySeconds = 0.0;
            dueSeconds = double.NegativeInfinity;
        }

        /// <summary>Forgets the failures: the next one counts as the first. Call it for another device.</summary>
        public void Restart()
        {
            Forget();
            hasFailed = false;
        }
    }

    /// <summary>Arrays for calls that take whole arrays: one per length, created at its first use and reused
    /// afterwards.</summary>
    public sealed class ArraysByLength<T>
    {
        private T[]?[] arrays = new T[]?[16];

        /// <summary>The array of a length; the same object each time.</summary>
        public T[] Of(int length)
        {
            if (arrays.Length <= length)
            {
                Array.Resize(ref arrays, 2 * length);
            }
            return arrays[length] ??= new T[length];
        }
    }
}
