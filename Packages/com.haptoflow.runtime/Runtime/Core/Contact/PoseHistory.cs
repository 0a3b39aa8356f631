#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>Where a surface was drawn in the last frames, for the tip's path over it.</summary>
    internal sealed class PoseHistory
    {
        public const int Capacity = TipHistory.Capacity;

        // A surface that has not changed its pose for so long is at rest.
        private const double RestSeconds = 0.35;

        private readonly double[] timesSeconds = new double[Capacity];
        private readonly double[] sinceStepSeconds = new double[Capacity];
        private readonly RigidPose[] poses = new RigidPose[Capacity];
        private readonly Double3[] scales = new Double3[Capacity];
        private int oldest;
        private double changedSeconds = double.NegativeInfinity;

        /// <summary>Number of frames kept; 0 for a surface whose own motion is not to be felt.</summary>
        public int Count { get; private set; }

        /// <summary>True where the pose has changed lately. A surface at rest costs nothing.</summary>
        public bool Moves => Count > 0 && SecondsAt(Count - 1) - changedSeconds <= RestSeconds;

        /// <summary>The pose of the newest frame; there must be one.</summary>
        public ref readonly RigidPose Newest => ref PoseAt(Count - 1);

        /// <summary>The scale of the newest frame.</summary>
        public Double3 NewestScale => ScaleAt(Count - 1);

        public double SecondsAt(int index) => timesSeconds[Slot(index)];

        /// <summary>Age of the last physics step at a frame; not a number where it is unknown.</summary>
        public double SinceStepSecondsAt(int index) => sinceStepSeconds[Slot(index)];

        /// <summary>The pose at a frame; 0 is the oldest.</summary>
        public ref readonly RigidPose PoseAt(int index) => ref poses[Slot(index)];

        public Double3 ScaleAt(int index) => scales[Slot(index)];

        public void Clear()
        {
            Count = 0;
            oldest = 0;
            changedSeconds = double.NegativeInfinity;
        }

        /// <summary>Records the surface's pose as it is drawn in a frame. A frame at almost the time of the last one
        /// replaces its pose; an earlier one restarts the history.</summary>
        /// <param name="timeSeconds">The tip's clock.</param>
        public void Record(double timeSeconds, in RigidPose pose) =>
            Record(timeSeconds, pose, new Double3(1.0, 1.0, 1.0), double.NaN);

        /// <summary>As <see cref="Record(double, in RigidPose)"/>, with the object's scale and the time since the last
        /// physics step, on the tip's clock; not a number where there is none.</summary>
        public void Record(double timeSeconds, in RigidPose pose, Double3 scale, double secondsSinceStep)
        {
            if (!Vectors.IsUsable(timeSeconds))
            {
                return;
            }
            if (Count > 0 && timeSeconds < SecondsAt(Count - 1))
            {
                Clear();
            }
            if (Count > 0 && !pose.Equals(Newest))
            {
                changedSeconds = timeSeconds;
            }
            if (Count == 0 || timeSeconds - SecondsAt(Count - 1) >= MinimumStepSeconds)
            {
                if (Count == Capacity)
                {
                    oldest = (oldest + 1) % Capacity;
                    --Count;
                }
                ++Count;
                timesSeconds[Slot(Count - 1)] = timeSeconds;
            }
            int newest = Slot(Count - 1);
            poses[newest] = pose;
            scales[newest] = scale;
            sinceStepSeconds[newest] = secondsSinceStep;
        }

        /// <summary>The frame of a time that was recorded; -1 without one.</summary>
        public int IndexOf(double timeSeconds)
        {
            for (int index = Count - 1; index >= 0 && SecondsAt(index) >= timeSeconds; --index)
            {
                if (SecondsAt(index) == timeSeconds)
                {
                    return index;
                }
            }
            return -1;
        }

        // As TipHistory, whose frames it shares.
        private static double MinimumStepSeconds { get; } = new VelocitySettings().MinimumStepSeconds;

        private int Slot(int index) => (oldest + index) % Capacity;
    }

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
