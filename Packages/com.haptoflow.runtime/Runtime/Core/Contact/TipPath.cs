#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>The tip in one frame.</summary>
    internal struct TipFrame
    {
        public double TimeSeconds;

        /// <summary>In the surface's coordinates.</summary>
        public Double3 PositionMetres;

        /// <summary>True for a new measurement, false where the tracker repeated its last one.</summary>
        public bool Fresh;

        /// <summary>Speed since the measurement before; infinite where it is not known.</summary>
        public double SpeedMps;
    }

    /// <summary>Relation of a frame to the one before.</summary>
    internal enum TipStep
    {
        Started,
        Continued,

        /// <summary>No hand makes this way in the time; see <see cref="TipPath"/>.</summary>
        Jumped,

        /// <summary>The time went backwards.</summary>
        ClockRestarted,

        /// <summary>After a pause that makes the path useless.</summary>
        Resumed,
    }

    /// <summary>The tip's recent positions in the coordinates of one surface, where motion that both share, as in a lift,
    /// does not show. Distinguishes positions that the tracker holds from stops, and jumps from strokes.</summary>
    /// <remarks>
    /// <para>A tracker slower than the frame rate repeats positions, in the world or, if the tip is carried, on the
    /// surface. Repetitions are not measurements and are left out of the velocity until <see
    /// cref="VelocitySettings.StopSeconds"/>; then, and not with the first repetition, the tip has really stopped and all
    /// of them count as measurements. A tracker that has measured in 32 frames in a row is trusted not to repeat
    /// positions: the first position that it repeats halves the weight of the velocity, and the second in a row is a
    /// stop. A tracker that has repeated positions and is not trusted since is slow: its positions may be older than the
    /// frames that report them, by up to a frame.</para>
    /// <para>A step is a jump (a teleport, a snap turn, tracking regained) if it is faster than <see
    /// cref="VelocitySettings.MaximumSpeedMps"/>, or faster than the last measurements by more than a hand can
    /// accelerate in the time: <see cref="VelocitySettings.MaximumGainMps"/>. A tip that is stopped, however hard, has
    /// not jumped.</para>
    /// </remarks>
    internal sealed class TipPath
    {
        public const int Capacity = 256;

        // A tracker that measured so often without repeating itself is trusted not to.
        private const int TrustedMeasurements = 32;

        // The first repetition of a position is no stop at any frame rate: a hitch shows one position for long, once.
        private const int StopRepeats = 2;

        // So many measurements tell how fast the tip was before a step.
        private const int MeasurementsBefore = 4;

        private readonly TipFrame[] frames = new TipFrame[Capacity];
        private readonly TrackerNoise noise;
        private int oldest;
        private double latestSeconds;
        private Double3 measuredMetres;
        private Double3 measuredWorldMetres;
        private double movedSeconds;
        private double moveSeconds;
        private int measurementsInRow;
        private int repeatsInRow;
        private bool hasRepeated;
        private bool resting;

        /// <param name="noise">The tracker's noise, learnt by every path of its tip.</param>
        public TipPath(TrackerNoise noise) => this.noise = noise;

        public int Count { get; private set; }

        public double MeasuredSeconds { get; private set; }

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
                // A frame that was skipped has told nothing.
                double held = Count == 0 ? 0.0 : Newest(0).TimeSeconds - MeasuredSeconds;
                return Vectors.Clamp((StopSeconds - held) / (StopSeconds - HoldSeconds), 0.0, 1.0);
            }
        }

        private bool IsTrusted => measurementsInRow >= TrustedMeasurements;

        private double HoldSeconds => IsTrusted
            ? Math.Min(VelocitySettings.HoldSeconds, 0.5 * moveSeconds)
            : VelocitySettings.HoldSeconds;

        private double StopSeconds => IsTrusted
            ? Math.Min(VelocitySettings.StopSeconds, 1.5 * moveSeconds)
            : VelocitySettings.StopSeconds;

        public ref readonly TipFrame Newest(int age) => ref At(Count - 1 - age);

        public void Clear()
        {
            Count = 0;
            oldest = 0;
            resting = false;
            hasRepeated = false;
            measurementsInRow = 0;
            repeatsInRow = 0;
        }

        public void Pass(double nowSeconds) => latestSeconds = Math.Max(latestSeconds, nowSeconds);

        /// <summary>Adds a frame; time and positions must be usable. Every result except Continued means that the path
        /// was discarded.</summary>
        public TipStep Add(double timeSeconds, Double3 surfaceMetres, Double3 worldMetres)
        {
            if (Count == 0)
            {
                return Start(TipStep.Started, timeSeconds, surfaceMetres, worldMetres, double.PositiveInfinity);
            }
            if (timeSeconds < latestSeconds)
            {
                return Start(
                    TipStep.ClockRestarted, timeSeconds, surfaceMetres, worldMetres, double.PositiveInfinity);
            }
            double moved = Double3.Distance(surfaceMetres, measuredMetres);
            double movedInWorld = Double3.Distance(worldMetres, measuredWorldMetres);
            double sinceMeasured = timeSeconds - MeasuredSeconds;
            double speed = moved / Math.Max(sinceMeasured, VelocitySettings.MinimumJumpSeconds);
            if (timeSeconds - latestSeconds > VelocitySettings.MaximumGapSeconds)
            {
                return Start(TipStep.Resumed, timeSeconds, surfaceMetres, worldMetres, double.PositiveInfinity);
            }
            // Under a tip that rests in the world each frame measures the surface.
            bool isHeld = movedInWorld <= VelocitySettings.MinimumMoveMetres;
            bool isJump = isHeld
                ? IsJump(Double3.Distance(surfaceMetres, Newest(0).PositionMetres),
                    timeSeconds - Newest(0).TimeSeconds, true)
                : IsJump(moved, sinceMeasured, false);
            if (isJump)
            {
                // What goes on at the speed of a jump is motion from then on.
                return Start(TipStep.Jumped, timeSeconds, surfaceMetres, worldMetres, speed);
            }
            latestSeconds = timeSeconds;
            double frameSeconds = timeSeconds - Newest(0).TimeSeconds;
            if (frameSeconds < VelocitySettings.MinimumStepSeconds)
            {
                return TipStep.Continued;
            }
            bool hasMoved = moved > VelocitySettings.MinimumMoveMetres && !isHeld;
            repeatsInRow = hasMoved ? 0 : repeatsInRow + 1;
            if (hasMoved)
            {
                Measure(timeSeconds, surfaceMetres, frameSeconds);
            }
            else if (repeatsInRow >= StopRepeats && sinceMeasured >= StopSeconds)
            {
                ConfirmStop(timeSeconds);
            }
            bool fresh = hasMoved || resting;
            Push(timeSeconds, surfaceMetres, fresh, speed);
            if (fresh)
            {
                MeasuredSeconds = timeSeconds;
                measuredMetres = surfaceMetres;
                measuredWorldMetres = worldMetres;
            }
            return TipStep.Continued;
        }

        private TipStep Start(
            TipStep step, double timeSeconds, Double3 surfaceMetres, Double3 worldMetres, double speedMps)
        {
            Count = 0;
            oldest = 0;
            resting = false;
            repeatsInRow = 0;
            noise.Restart();
            noise.Add(timeSeconds, surfaceMetres);
            movedSeconds = timeSeconds;
            Push(timeSeconds, surfaceMetres, true, speedMps);
            latestSeconds = timeSeconds;
            MeasuredSeconds = timeSeconds;
            measuredMetres = surfaceMetres;
            measuredWorldMetres = worldMetres;
            return step;
        }

        private bool IsJump(double moved, double seconds, bool isHeld)
        {
            double fastestBefore = 0.0;
            int measurements = 0;
            for (int age = 0; age < Count && measurements < MeasurementsBefore; ++age)
            {
                ref readonly TipFrame frame = ref Newest(age);
                if (frame.Fresh)
                {
                    fastestBefore = Math.Max(fastestBefore, frame.SpeedMps);
                    ++measurements;
                }
            }
            if (isHeld && double.IsPositiveInfinity(fastestBefore))
            {
                // A tip whose speed is not known yet may be fast, but not one that rests in the world.
                fastestBefore = 0.0;
            }
            return VelocitySettings.IsJump(moved, seconds, fastestBefore);
        }

        /// <summary>Learns about the tracker from a position that differs from the last.</summary>
        private void Measure(double timeSeconds, Double3 surfaceMetres, double frameSeconds)
        {
            moveSeconds = timeSeconds - movedSeconds;
            movedSeconds = timeSeconds;
            resting = false;
            measurementsInRow = Math.Min(measurementsInRow + 1, TrustedMeasurements);
            if (moveSeconds > frameSeconds)
            {
                noise.Restart();
                if (moveSeconds <= VelocitySettings.StopSeconds)
                {
                    hasRepeated = true;
                    measurementsInRow = 0;
                }
            }
            noise.Add(timeSeconds, surfaceMetres);
        }

        private void ConfirmStop(double timeSeconds)
        {
            if (resting)
            {
                return;
            }
            resting = true;
            while (Count > 0 && At(0).TimeSeconds < MeasuredSeconds)
            {
                DropOldest();
            }
            for (int index = 0; index < Count; ++index)
            {
                At(index).Fresh = true;
            }
            MeasuredSeconds = timeSeconds;
        }

        private ref TipFrame At(int index) => ref frames[(oldest + index) % Capacity];

        private void Push(double timeSeconds, Double3 surfaceMetres, bool fresh, double speedMps)
        {
            if (Count == Capacity)
            {
                DropOldest();
            }
            ++Count;
            ref TipFrame frame = ref At(Count - 1);
            frame.TimeSeconds = timeSeconds;
            frame.PositionMetres = surfaceMetres;
            frame.Fresh = fresh;
            frame.SpeedMps = speedMps;
        }

        private void DropOldest()
        {
            oldest = (oldest + 1) % Capacity;
            --Count;
        }
    }
}
