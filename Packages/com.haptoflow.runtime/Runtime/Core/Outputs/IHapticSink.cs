#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>What a device takes, best last.</summary>
    public enum HapticForm
    {
        /// <summary>One amplitude at a time, for a motor.</summary>
        Amplitude = 0,

        /// <summary>Amplitude and frequency over time, and transients.</summary>
        Parametric = 1,

        /// <summary>The wave itself.</summary>
        Waveform = 2,
    }

    /// <summary>What a device says of itself at present.</summary>
    public readonly struct HapticSinkCapabilities : IEquatable<HapticSinkCapabilities>
    {
        /// <param name="rateHz">See <see cref="RateHz"/>.</param>
        /// <param name="maximumSamples">See <see cref="MaximumSamples"/>.</param>
        /// <param name="minFrequencyHz">See <see cref="MinFrequencyHz"/>.</param>
        /// <param name="maxFrequencyHz">See <see cref="MaxFrequencyHz"/>.</param>
        /// <param name="leastDepthSeconds">See <see cref="MinimumDepthSeconds"/>.</param>
        public HapticSinkCapabilities(double rateHz, int maximumSamples = int.MaxValue, double minFrequencyHz = 0.0,
            double maxFrequencyHz = 0.0, double leastDepthSeconds = 0.0)
        {
            RateHz = rateHz;
            MaximumSamples = maximumSamples;
            MinFrequencyHz = minFrequencyHz;
            MaxFrequencyHz = maxFrequencyHz;
            MinimumDepthSeconds = leastDepthSeconds;
        }

        /// <summary>Waveform: samples a second. Otherwise the most submissions a second; 0 for one with every frame.
        /// </summary>
        public double RateHz { get; }

        /// <summary>Waveform: the most samples in one submission.</summary>
        public int MaximumSamples { get; }

        /// <summary>Parametric: the frequency that 0 stands for. Amplitude: the lowest that the motor plays. In Hz; 0
        /// where the device does not say it, and a motor then counts as one of 160 Hz.</summary>
        public double MinFrequencyHz { get; }

        /// <summary>The same for 1, and for the highest.</summary>
        public double MaxFrequencyHz { get; }

        /// <summary>What the first submission has to last at least, in s.</summary>
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

    /// <summary>A device that can be felt, as an output sees it. Everything on the main thread, without garbage.
    /// </summary>
    public interface IHapticSink
    {
        /// <summary>What people call the device; for messages.</summary>
        string Name { get; }

        /// <summary>What the device takes now. Asked with every frame: must be cheap, and must not log.</summary>
        /// <returns>False while there is no such device: it is gone or asleep.</returns>
        bool TryGetCapabilities(out HapticSinkCapabilities capabilities);

        /// <summary>Ends whatever plays, at once.</summary>
        void Stop();
    }

    /// <summary>Takes the wave.</summary>
    public interface IWaveformSink : IHapticSink
    {
        /// <summary>A submission that replaces what plays goes on without a gap. Where this is false, submissions queue
        /// behind each other, and replacing is kept for the rare moments that need it.</summary>
        bool ReplacesWithoutGap { get; }

        /// <param name="samples">Within +-1, at the device's rate.</param>
        /// <param name="replace">Starts at once in place of what plays; otherwise behind it.</param>
        /// <returns>How many of the samples the device took; -1 where it is gone.</returns>
        int Submit(ReadOnlySpan<float> samples, bool replace);
    }

    /// <summary>A value at a time from the start of a stream.</summary>
    public readonly struct ParametricPoint
    {
        /// <param name="seconds">See <see cref="Seconds"/>.</param>
        /// <param name="value">See <see cref="Value"/>.</param>
        public ParametricPoint(double seconds, float value)
        {
            Seconds = seconds;
            Value = value;
        }

        /// <summary>From the start of the stream, in s.</summary>
        public double Seconds { get; }

        /// <summary>0 to 1.</summary>
        public float Value { get; }
    }

    /// <summary>A short knock at a time from the start of a stream.</summary>
    public readonly struct ParametricTransient
    {
        /// <param name="seconds">See <see cref="Seconds"/>.</param>
        /// <param name="amplitude">See <see cref="Amplitude"/>.</param>
        /// <param name="frequency">See <see cref="Frequency"/>.</param>
        public ParametricTransient(double seconds, float amplitude, float frequency)
        {
            Seconds = seconds;
            Amplitude = amplitude;
            Frequency = frequency;
        }

        /// <summary>From the start of the stream, in s.</summary>
        public double Seconds { get; }

        /// <summary>0 to 1.</summary>
        public float Amplitude { get; }

        /// <summary>0 to 1, of the device's frequency range.</summary>
        public float Frequency { get; }
    }

    /// <summary>Which part of a stream a frame of points is.</summary>
    public enum StreamPart
    {
        /// <summary>Starts a stream in place of what plays; its first points are at 0 s.</summary>
        First = 1,

        /// <summary>Goes on behind the last point sent.</summary>
        Intermediate = 2,

        /// <summary>The stream ends with its last point.</summary>
        Last = 3,
    }

    /// <summary>Takes amplitude and frequency over time.</summary>
    public interface IParametricSink : IHapticSink
    {
        /// <summary>Times rise, and no frequency and no transient lies behind the last amplitude.</summary>
        /// <returns>False where the device is gone.</returns>
        bool Submit(ReadOnlySpan<ParametricPoint> amplitudes, ReadOnlySpan<ParametricPoint> frequencies,
            ReadOnlySpan<ParametricTransient> transients, StreamPart part);
    }

    /// <summary>Takes one amplitude at a time.</summary>
    public interface IAmplitudeSink : IHapticSink
    {
        /// <summary>Replaces what plays, and ends by itself.</summary>
        /// <param name="amplitude">0 to 1.</param>
        /// <param name="frequencyHz">Where most of the wave's energy is; devices with one frequency ignore it.</param>
        /// <param name="durationSeconds">After which the device stops unless something else comes.</param>
        /// <returns>False where the device is gone.</returns>
        bool Submit(float amplitude, float frequencyHz, float durationSeconds);
    }

    /// <summary>Where a queue gets the wave from: it drives the clock of what it asks.</summary>
    public interface IWaveSource
    {
        /// <summary>A mute, a pause or a panic holds: what is on its way to the device must not be felt any more.
        /// </summary>
        bool IsStopped { get; }

        /// <summary>The next samples, within +-1, of a wave at <see cref="WaveHistory.RateHz"/>.</summary>
        void Render(Span<float> samples);
    }
}
