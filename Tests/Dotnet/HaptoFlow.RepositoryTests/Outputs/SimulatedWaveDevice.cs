#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Outputs;

namespace HaptoFlow.RepositoryTests.Outputs
{
    /// <summary>A controller with its own clock. It plays submitted samples one after another, and 0 when it has none.
    /// A submission that replaces the previous one is played from the moment of the call.</summary>
    internal sealed class SimulatedWaveDevice : IWaveformSink
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

        public int Stops { get; private set; }

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

        public void Stop()
        {
            ++Stops;
            waiting.Clear();
        }

        private double Now { get; set; }
    }
}
