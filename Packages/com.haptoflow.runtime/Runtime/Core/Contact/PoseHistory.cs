#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>Recent poses of a surface, for the tip's velocity relative to it.</summary>
    internal sealed class PoseHistory
    {
        public const int Capacity = 64;

        // Extrapolation limit beyond the last pose, in intervals between poses.
        private const double MaximumExtrapolation = 1.5;

        private readonly double[] timesSeconds = new double[Capacity];
        private readonly RigidPose[] poses = new RigidPose[Capacity];
        private int oldest;

        /// <summary>Number of poses kept.</summary>
        public int Count { get; private set; }

        /// <summary>True where two of the poses differ. A surface at rest costs nothing and adds no rounding.</summary>
        public bool Moves { get; private set; }

        public void Clear()
        {
            Count = 0;
            oldest = 0;
            Moves = false;
        }

        /// <summary>Records the surface's pose. The same time as the last replaces it; an earlier one restarts the
        /// history.</summary>
        public void Record(double timeSeconds, in RigidPose pose)
        {
            if (!Vectors.IsUsable(timeSeconds))
            {
                return;
            }
            if (Count > 0 && timeSeconds < TimeAt(Count - 1))
            {
                Clear();
            }
            bool same = Count > 0 && pose.Equals(Recorded(Count - 1));
            if (Count > 0 && timeSeconds == TimeAt(Count - 1))
            {
                Moves = Moves || (Count > 1 && !same);
                poses[Slot(Count - 1)] = pose;
                return;
            }
            if (Count == Capacity)
            {
                oldest = (oldest + 1) % Capacity;
                --Count;
            }
            Moves = Moves || (Count > 0 && !same);
            ++Count;
            timesSeconds[Slot(Count - 1)] = timeSeconds;
            poses[Slot(Count - 1)] = pose;
        }

        /// <summary>False for a time before the first pose.</summary>
        internal bool Knows(double timeSeconds) => Count > 0 && timeSeconds >= TimeAt(0);

        /// <summary>The pose at a time: recorded, interpolated, or extrapolated by at most one and a half intervals.
        /// Requires at least one pose.</summary>
        internal RigidPose PoseAt(double timeSeconds)
        {
            int after = Count;
            while (after > 0 && TimeAt(after - 1) > timeSeconds)
            {
                --after;
            }
            if (after == 0)
            {
                return Recorded(0);
            }
            if (TimeAt(after - 1) == timeSeconds || Count == 1)
            {
                return Recorded(after - 1);
            }
            int right = after == Count ? after - 1 : after;
            double from = TimeAt(right - 1);
            double share = (timeSeconds - from) / (TimeAt(right) - from);
            share = share > 1.0 + MaximumExtrapolation ? 1.0 + MaximumExtrapolation : share;
            return RigidPose.Between(Recorded(right - 1), Recorded(right), share);
        }

        private int Slot(int index) => (oldest + index) % Capacity;

        private double TimeAt(int index) => timesSeconds[Slot(index)];

        private RigidPose Recorded(int index) => poses[Slot(index)];
    }
}
