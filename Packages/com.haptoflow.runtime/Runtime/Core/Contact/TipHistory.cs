#nullable enable
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
    /// them count as measurements.</remarks>
    internal sealed class TipHistory
    {
        public const int Capacity = 256;

        private readonly TipFrame[] frames = new TipFrame[Capacity];
        private int oldest;
        private double latestSeconds;
        private double measuredSeconds;
        private Double3 measuredMetres;
        private bool resting;

        public TipHistory(VelocitySettings settings) => Settings = settings;

        public VelocitySettings Settings { get; }

        public int Count { get; private set; }

        /// <summary>Weight of the last measurement's velocity: 1 up to the hold time, falling to 0 at the stop
        /// time.</summary>
        public double Confidence
        {
            get
            {
                double held = latestSeconds - measuredSeconds;
                double fading = Settings.StopSeconds - Settings.HoldSeconds;
                return Vectors.Clamp((Settings.StopSeconds - held) / fading, 0.0, 1.0);
            }
        }

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
            if (timeSeconds - Newest(0).TimeSeconds < Settings.MinimumStepSeconds)
            {
                return TipStep.Continued;
            }
            if (moved > Settings.MinimumMoveMetres)
            {
                resting = false;
            }
            else if (sinceMeasured >= Settings.StopSeconds)
            {
                ConfirmStop(timeSeconds);
            }
            bool fresh = resting || moved > Settings.MinimumMoveMetres;
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
            Push(timeSeconds, positionMetres, true);
            latestSeconds = timeSeconds;
            measuredSeconds = timeSeconds;
            measuredMetres = positionMetres;
            return step;
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
