#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Outputs;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>A device whose clock the test moves.</summary>
    internal interface ISimulatedDevice
    {
        void AdvanceTo(double seconds);
    }

    internal static class Playback
    {
        public const double FrameSeconds = 1.0 / 72.0;

        /// <summary>Updates a queue once a frame.</summary>
        /// <returns>The time after the last frame.</returns>
        public static double Play(ISimulatedDevice device, HapticQueue queue, double from, double seconds)
        {
            double now = from;
            for (; now < from + seconds; now += FrameSeconds)
            {
                device.AdvanceTo(now);
                queue.Update(now);
            }
            device.AdvanceTo(now);
            return now;
        }
    }

    /// <summary>A motor that plays each command for its duration.</summary>
    internal sealed class SimulatedMotor : IAmplitudeSink, ISimulatedDevice
    {
        private double endsSeconds;
        private float amplitude;

        public string Name => "simulated";

        public double RateHz { get; set; }

        public double MinFrequencyHz { get; set; }

        public double MaxFrequencyHz { get; set; }

        public bool IsThere { get; set; } = true;

        public double Now { get; private set; }

        public List<(double Seconds, float Amplitude, float Hertz, float Duration)> Commands { get; } =
            new List<(double, float, float, float)>();

        public void AdvanceTo(double seconds) => Now = seconds;

        public float AmplitudeAt(double seconds) => seconds < endsSeconds ? amplitude : 0f;

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            capabilities = new HapticSinkCapabilities(RateHz, int.MaxValue, MinFrequencyHz, MaxFrequencyHz);
            return IsThere;
        }

        public bool Submit(float newAmplitude, float frequencyHz, float durationSeconds)
        {
            if (!IsThere)
            {
                return false;
            }
            amplitude = newAmplitude;
            endsSeconds = Now + durationSeconds;
            Commands.Add((Now, newAmplitude, frequencyHz, durationSeconds));
            return true;
        }

        public void Stop() => endsSeconds = Now;
    }

    /// <summary>A device that plays streams of points on its own clock, and checks the rules of its makers. A stream
    /// without new points continues for 50 ms.</summary>
    internal sealed class SimulatedParametricDevice : IParametricSink, ISimulatedDevice
    {
        private const double ExtensionSeconds = 0.05;

        private readonly List<ParametricPoint> points = new List<ParametricPoint>();
        private double beganSeconds;
        private bool hasEnded = true;

        public string Name => "simulated";

        public double Drift { get; set; }

        public double RateHz { get; set; }

        public double MinimumFirstSeconds { get; set; } = 0.02;

        public bool IsThere { get; set; } = true;

        public double Now { get; private set; }

        public int Streams { get; private set; }

        public int Submissions { get; private set; }

        public List<ParametricTransient> Knocks { get; } = new List<ParametricTransient>();

        /// <summary>Of all points of all streams.</summary>
        public List<double> Amplitudes { get; } = new List<double>();

        public (double Lowest, double Highest) RangeHz { get; set; } = (50.0, 450.0);

        public float LastFrequency { get; private set; }

        /// <summary>The part of the stream that is not yet played, in seconds.</summary>
        public double DepthSeconds => points.Count == 0 || hasEnded ? 0.0 : points[^1].Seconds - StreamTime(Now);

        /// <summary>How often the points ran out before the stream ended.</summary>
        public bool IsStarved => points.Count > 0 && !hasEnded && StreamTime(Now) > points[^1].Seconds;

        public void AdvanceTo(double seconds) => Now = seconds;

        public float AmplitudeAt(double seconds)
        {
            double time = StreamTime(seconds);
            if (points.Count == 0 || time < 0.0)
            {
                return 0f;
            }
            for (int index = 1; index < points.Count; ++index)
            {
                if (time <= points[index].Seconds)
                {
                    double share = (time - points[index - 1].Seconds) /
                        (points[index].Seconds - points[index - 1].Seconds);
                    return (float)(points[index - 1].Value + share * (points[index].Value - points[index - 1].Value));
                }
            }
            return !hasEnded && time < points[^1].Seconds + ExtensionSeconds ? points[^1].Value : 0f;
        }

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            capabilities = new HapticSinkCapabilities(
                RateHz, 500, RangeHz.Lowest, RangeHz.Highest, MinimumFirstSeconds);
            return IsThere;
        }

        public bool Submit(ReadOnlySpan<ParametricPoint> amplitudes, ReadOnlySpan<ParametricPoint> frequencies,
            ReadOnlySpan<ParametricTransient> transients, StreamPart part)
        {
            if (!IsThere)
            {
                return false;
            }
            ++Submissions;
            bool first = part == StreamPart.First;
            Require(amplitudes.Length >= (first ? 2 : 1), "too few amplitudes");
            Require(amplitudes.Length <= 500 && frequencies.Length <= 500 && transients.Length <= 500, "too many points");
            if (first)
            {
                ++Streams;
                points.Clear();
                beganSeconds = Now;
                hasEnded = false;
                Require(amplitudes[0].Seconds == 0.0 && frequencies[0].Seconds == 0.0, "a stream begins at 0");
                Require(amplitudes[^1].Seconds >= MinimumFirstSeconds - 1e-9, "the first frame is too short");
            }
            else
            {
                Require(!hasEnded, "there is no stream to continue");
            }
            foreach (ParametricPoint point in amplitudes)
            {
                Require(points.Count == 0 || point.Seconds > points[^1].Seconds, "times must rise");
                Require(point.Value >= 0f && point.Value <= 1f, "an amplitude is out of range");
                points.Add(point);
                Amplitudes.Add(point.Value);
            }
            foreach (ParametricPoint point in frequencies)
            {
                Require(point.Value >= 0f && point.Value <= 1f, "a frequency is out of range");
                LastFrequency = point.Value;
            }
            Require(frequencies[^1].Seconds <= amplitudes[^1].Seconds, "a frequency behind the last amplitude");
            foreach (ParametricTransient knock in transients)
            {
                Require(knock.Seconds >= 0.0 && knock.Seconds <= amplitudes[^1].Seconds, "a transient is out of range");
                Knocks.Add(knock);
            }
            hasEnded = part == StreamPart.Last;
            if (points.Count > 4000)
            {
                points.RemoveRange(0, 2000);
            }
            return true;
        }

        public void Stop()
        {
            points.Clear();
            hasEnded = true;
        }

        private double StreamTime(double seconds) => (seconds - beganSeconds) * (1.0 + Drift);

        private static void Require(bool holds, string rule)
        {
            if (!holds)
            {
                throw new InvalidOperationException(rule);
            }
        }
    }

    /// <summary>A controller with its own clock. It plays submitted samples one after another, and 0 when it has none.
    /// A submission that replaces the previous one is played from the moment of the call.</summary>
    internal sealed class SimulatedWaveDevice : IWaveformSink, ISimulatedDevice
    {
        private readonly Queue<float> waiting = new Queue<float>();
        private double nextSampleSeconds;
        private double rateHz;

        public SimulatedWaveDevice(double rateHz, double drift = 0.0, bool replacesWithoutGap = true)
        {
            RateHz = rateHz;
            Drift = drift;
            ReplacesWithoutGap = replacesWithoutGap;
        }

        public string Name => "simulated";

        /// <summary>Changing the rate simulates another device, which has no samples.</summary>
        public double RateHz
        {
            get => rateHz;
            set
            {
                rateHz = value;
                waiting.Clear();
            }
        }

        public double Drift { get; set; }

        public bool ReplacesWithoutGap { get; }

        public bool IsThere { get; set; } = true;

        public int Capacity { get; set; } = 4000;

        /// <summary>The time and value of each played sample.</summary>
        public List<(double Seconds, float Sample)> Played { get; } = new List<(double, float)>();

        /// <summary>The number of samples that were due while the queue was empty.</summary>
        public int Starved { get; private set; }

        public double DepthSeconds => waiting.Count / (RateHz * (1.0 + Drift));

        public int Submissions { get; private set; }

        public bool Records { get; set; } = true;

        public void AdvanceTo(double seconds)
        {
            double step = 1.0 / (RateHz * (1.0 + Drift));
            for (; nextSampleSeconds <= seconds; nextSampleSeconds += step)
            {
                bool has = waiting.Count > 0;
                Starved += has ? 0 : 1;
                float sample = has ? waiting.Dequeue() : 0f;
                if (Records)
                {
                    Played.Add((nextSampleSeconds, sample));
                }
            }
            Now = seconds;
        }

        public void ForgetStarvation() => Starved = 0;

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            capabilities = new HapticSinkCapabilities(RateHz, 4000);
            return IsThere;
        }

        public int Submit(ReadOnlySpan<float> samples, bool replace)
        {
            if (!IsThere)
            {
                return -1;
            }
            ++Submissions;
            if (replace)
            {
                waiting.Clear();
                nextSampleSeconds = Now;
            }
            int taken = Math.Min(samples.Length, Capacity - waiting.Count);
            for (int index = 0; index < taken; ++index)
            {
                waiting.Enqueue(samples[index]);
            }
            return taken;
        }

        public void Stop() => waiting.Clear();

        private double Now { get; set; }
    }

    /// <summary>A wave that can be evaluated at every position.</summary>
    internal sealed class SimulatedWave : IWaveSource
    {
        private readonly Func<double, double> wave;

        /// <param name="wave">Maps a time in seconds to a sample.</param>
        public SimulatedWave(Func<double, double> wave) => this.wave = wave;

        public static SimulatedWave Sine(double hertz, double amplitude = 0.3) =>
            new SimulatedWave(seconds => amplitude * Math.Sin(2.0 * Math.PI * hertz * seconds));

        public long Position { get; private set; }

        public bool IsSilent { get; set; }

        public bool IsStopped { get; set; }

        public void Render(Span<float> samples)
        {
            for (int index = 0; index < samples.Length; ++index, ++Position)
            {
                samples[index] = IsSilent ? 0f : (float)wave(Position / WaveHistory.RateHz);
            }
        }
    }
}
