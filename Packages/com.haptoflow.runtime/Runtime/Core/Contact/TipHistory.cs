#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>The tip's last positions in the world, of which the path over a surface is made when the tip comes to
    /// it. Whether a step is a jump only a surface can tell.</summary>
    internal sealed class TipHistory
    {
        public const int Capacity = 64;

        private readonly double[] timesSeconds = new double[Capacity];
        private readonly Double3[] worldMetres = new Double3[Capacity];
        private readonly VelocitySettings settings;
        private int oldest;
        private double latestSeconds;

        public TipHistory(VelocitySettings settings) => this.settings = settings;

        public int Count { get; private set; }

        /// <summary>The time of a frame; 0 is the oldest.</summary>
        public double SecondsAt(int index) => timesSeconds[(oldest + index) % Capacity];

        /// <summary>The position at a frame; 0 is the oldest.</summary>
        public Double3 WorldMetresAt(int index) => worldMetres[(oldest + index) % Capacity];

        public void Clear()
        {
            Count = 0;
            oldest = 0;
        }

        /// <summary>Advances the clock without a measurement, so that the time until the next one is no
        /// pause.</summary>
        public void Pass(double nowSeconds) => latestSeconds = Math.Max(latestSeconds, nowSeconds);

        /// <summary>Adds a frame; time and position must be usable. Every result except Continued means that the history
        /// was discarded.</summary>
        public TipStep Add(double nowSeconds, Double3 tipMetres)
        {
            TipStep step = Count == 0 ? TipStep.Started : TipStep.Continued;
            if (Count > 0 && nowSeconds < latestSeconds)
            {
                step = TipStep.ClockRestarted;
            }
            else if (Count > 0 && nowSeconds - latestSeconds > settings.MaximumGapSeconds)
            {
                step = TipStep.Resumed;
            }
            if (step != TipStep.Continued)
            {
                Clear();
            }
            latestSeconds = nowSeconds;
            if (Count > 0 && nowSeconds - SecondsAt(Count - 1) < settings.MinimumStepSeconds)
            {
                return step;
            }
            if (Count == Capacity)
            {
                oldest = (oldest + 1) % Capacity;
                --Count;
            }
            int slot = (oldest + Count) % Capacity;
            timesSeconds[slot] = nowSeconds;
            worldMetres[slot] = tipMetres;
            ++Count;
            return step;
        }
    }
}
