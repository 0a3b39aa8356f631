#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Outputs;

namespace HaptoFlow.RepositoryTests.Outputs
{
    /// <summary>A controller with a clock of its own: it plays what it was sent, one sample after the other, and 0 where
    /// it has none. A submission that replaces is played from the moment of the call.</summary>
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

        /// <summary>A device with another rate is another device: it knows nothing of what was sent.</summary>
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

        /// <summary>When each sample was played, and what it was.</summary>
        public List<(double Seconds, float Sample)> Played { get; } = new List<(double, float)>();

        /// <summary>Samples that were due while nothing was left.</summary>
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
