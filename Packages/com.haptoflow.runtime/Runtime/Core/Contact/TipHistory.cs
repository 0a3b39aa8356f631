#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>The tip at one frame.</summary>
    internal struct TipFrame
    {
        public double TimeSeconds;
        public Double3 PositionMetres;

        /// <summary>A measurement of its own; otherwise the tracker repeated its last one.</summary>
        public bool Fresh;
    }

    /// <summary>How a frame follows the last.</summary>
    internal enum TipStep
    {
        Started,
        Continued,

        /// <summary>Too far in too short a time.</summary>
        Teleported,

        /// <summary>The time went backwards.</summary>
        ClockRestarted,

        /// <summary>After a pause so long that the past says nothing.</summary>
        Resumed,
    }

    /// <summary>The last frames of the tip, with tracker hold told from stops.</summary>
    /// <remarks>A tracker slower than the frame rate repeats positions. Repeats are no measurements and stay out of the
    /// velocity until <see cref="VelocitySettings.StopSeconds"/>; then the tip has really stopped and all of them were
    /// measurements.</remarks>
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

        /// <summary>How far the last measurement's velocity still holds now: 1 up to the hold time after it, 0 from the
        /// stop time.</summary>
        public double Confidence
        {
            get
            {
                double held = latestSeconds - measuredSeconds;
                double fading = Settings.StopSeconds - Settings.HoldSeconds;
                return Vectors.Clamp((Settings.StopSeconds - held) / fading, 0.0, 1.0);
            }
        }

        /// <summary>By age, 0 being the newest.</summary>
        public ref readonly TipFrame Newest(int age) => ref At(Count - 1 - age);

        public void Clear()
        {
            Count = 0;
            oldest = 0;
            resting = false;
        }

        /// <summary>Time and position must be usable. Whatever the answer but continued, the past is gone.</summary>
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
            if (timeSeconds - latestSeconds > Settings.LongestGapSeconds)
            {
                return Start(TipStep.Resumed, timeSeconds, positionMetres);
            }
            if (moved > Settings.MaximumMoveMetres(sinceMeasured))
            {
                return Start(TipStep.Teleported, timeSeconds, positionMetres);
            }
            latestSeconds = timeSeconds;
            if (timeSeconds - Newest(0).TimeSeconds < Settings.ShortestStepSeconds)
            {
                return TipStep.Continued;
            }
            if (moved > Settings.SmallestMoveMetres)
            {
                resting = false;
            }
            else if (sinceMeasured >= Settings.StopSeconds)
            {
                ConfirmStop(timeSeconds);
            }
            bool fresh = resting || moved > Settings.SmallestMoveMetres;
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
