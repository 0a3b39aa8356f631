#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>The tip in one frame.</summary>
    internal struct TipFrame
    {
        public double TimeSeconds;
        public Double3 PositionMetres;

        /// <summary>True for a new measurement, false where the tracker repeated its last one.</summary>
        public bool Fresh;
    }

    /// <summary>Relation of a frame to the one before.</summary>
    internal enum TipStep
    {
        Started,
        Continued,

        /// <summary>Moved farther than a hand can in the time.</summary>
        Teleported,

        /// <summary>The time went backwards.</summary>
        ClockRestarted,

        /// <summary>After a pause that makes the history useless.</summary>
        Resumed,
    }

    /// <summary>The last frames of the tip; distinguishes repeated positions of a slow tracker from real
    /// stops.</summary>
    /// <remarks>A tracker slower than the frame rate repeats positions. Repetitions are not measurements and are left
    /// out of the velocity until <see cref="VelocitySettings.StopSeconds"/>; then the tip has really stopped and all of
    /// them count as measurements. A tracker that has measured in 32 frames in a row is trusted not to repeat positions:
    /// the first position that it repeats halves the weight of the velocity, and the second in a row is a stop. A tracker
    /// that has repeated positions and is not trusted since is slow: its positions may be older than the frames that
    /// report them, by up to a frame.</remarks>
    internal sealed class TipHistory
    {
        public const int Capacity = 256;

        // A tracker that measured so often without repeating itself is trusted not to.
        private const int TrustedMeasurements = 32;

        private readonly TipFrame[] frames = new TipFrame[Capacity];
        private readonly TrackerNoise noise = new TrackerNoise();
        private int oldest;
        private double latestSeconds;
        private double measuredSeconds;
        private Double3 measuredMetres;
        private double movedSeconds;
        private double moveSeconds;
        private int measurementsInRow;
        private bool hasRepeated;
        private bool resting;

        public TipHistory(VelocitySettings settings) => Settings = settings;

        public VelocitySettings Settings { get; }

        public int Count { get; private set; }

        /// <summary>Noise of the positions on each axis.</summary>
        public double NoiseMetres => noise.Metres;

        /// <summary>True if the tracker repeated itself within its last measurements.</summary>
        public bool IsSlow => hasRepeated && !IsTrusted;

        /// <summary>Weight of the last measurement's velocity: 1 up to the hold time, falling to 0 at the stop
        /// time.</summary>
        public double Confidence
        {
            get
            {
                double held = latestSeconds - measuredSeconds;
                return Vectors.Clamp((StopSeconds - held) / (StopSeconds - HoldSeconds), 0.0, 1.0);
            }
        }

        private bool IsTrusted => measurementsInRow >= TrustedMeasurements;

        private double HoldSeconds => IsTrusted
            ? Math.Min(Settings.HoldSeconds, 0.5 * moveSeconds)
            : Settings.HoldSeconds;

        private double StopSeconds => IsTrusted
            ? Math.Min(Settings.StopSeconds, 1.5 * moveSeconds)
            : Settings.StopSeconds;

        /// <summary>The frame of an age; 0 is the newest.</summary>
        public ref readonly TipFrame Newest(int age) => ref At(Count - 1 - age);

        public void Clear()
        {
            Count = 0;
            oldest = 0;
            resting = false;
        }

        /// <summary>Adds a frame; time and position must be usable. Every result except Continued means that the
        /// history was discarded.</summary>
        public TipStep Add(double timeSeconds, Double3 positionMetres)
        {
            if (Count == 0)
            {
                return Start(TipStep.Started, timeSeconds, positionMetres);
            }
            if (timeSeconds < latestSeconds)
            {
                return Start(TipStep.ClockRestarted, timeSeconds, positionMetres);
            }
            double moved = Double3.Distance(positionMetres, measuredMetres);
            double sinceMeasured = timeSeconds - measuredSeconds;
            if (timeSeconds - latestSeconds > Settings.MaximumGapSeconds)
            {
                return Start(TipStep.Resumed, timeSeconds, positionMetres);
            }
            if (moved > Settings.MaximumMoveMetres(sinceMeasured))
            {
                return Start(TipStep.Teleported, timeSeconds, positionMetres);
            }
            latestSeconds = timeSeconds;
            double frameSeconds = timeSeconds - Newest(0).TimeSeconds;
            if (frameSeconds < Settings.MinimumStepSeconds)
            {
                return TipStep.Continued;
            }
            bool hasMoved = moved > Settings.MinimumMoveMetres;
            if (hasMoved)
            {
                Measure(timeSeconds, positionMetres, frameSeconds);
            }
            else if (sinceMeasured >= StopSeconds)
            {
                ConfirmStop(timeSeconds);
            }
            bool fresh = hasMoved || resting;
            Push(timeSeconds, positionMetres, fresh);
            if (fresh)
            {
                measuredSeconds = timeSeconds;
                measuredMetres = positionMetres;
            }
            return TipStep.Continued;
        }

        private TipStep Start(TipStep step, double timeSeconds, Double3 positionMetres)
        {
            Clear();
            noise.Restart();
            noise.Add(timeSeconds, positionMetres);
            movedSeconds = timeSeconds;
            Push(timeSeconds, positionMetres, true);
            latestSeconds = timeSeconds;
            measuredSeconds = timeSeconds;
            measuredMetres = positionMetres;
            return step;
        }

        /// <summary>Learns about the tracker from a position that differs from the last.</summary>
        private void Measure(double timeSeconds, Double3 positionMetres, double frameSeconds)
        {
            moveSeconds = timeSeconds - movedSeconds;
            movedSeconds = timeSeconds;
            resting = false;
            measurementsInRow = Math.Min(measurementsInRow + 1, TrustedMeasurements);
            if (moveSeconds > frameSeconds)
            {
                noise.Restart();
                if (moveSeconds <= Settings.StopSeconds)
                {
                    hasRepeated = true;
                    measurementsInRow = 0;
                }
            }
            noise.Add(timeSeconds, positionMetres);
        }

        private void ConfirmStop(double timeSeconds)
        {
            if (resting)
            {
                return;
            }
            resting = true;
            while (Count > 0 && At(0).TimeSeconds < measuredSeconds)
            {
                DropOldest();
            }
            for (int index = 0; index < Count; ++index)
            {
                At(index).Fresh = true;
            }
            measuredSeconds = timeSeconds;
        }

        private ref TipFrame At(int index) => ref frames[(oldest + index) % Capacity];

        private void Push(double timeSeconds, Double3 positionMetres, bool fresh)
        {
            if (Count == Capacity)
            {
                DropOldest();
            }
            ++Count;
            ref TipFrame frame = ref At(Count - 1);
            frame.TimeSeconds = timeSeconds;
            frame.PositionMetres = positionMetres;
            frame.Fresh = fresh;
        }

        private void DropOldest()
        {
            oldest = (oldest + 1) % Capacity;
            --Count;
        }
    }
}
