#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>The tip's path over the surface that it touches, and its velocity there.</summary>
    /// <remarks>Tip and surface are read in the same frame, so that a tip which is carried along, by whatever, and
    /// however it steps, is at rest. A tip that is not carried by a surface which moves in steps slides evenly over the
    /// surface that its steps describe (<see cref="SteppedPoses"/>). Which of the two it is, the smoother path
    /// tells.</remarks>
    internal sealed class TouchedPath
    {
        // The path is judged over this time.
        private const double WindowSeconds = 0.3;

        // The other path must halve the changes of velocity, as far as rounding and noise do not make them.
        private const double Better = 0.25;
        private const double LeastMps = 0.001;

        // Fewer frames tell nothing: after a hitch what was found before it stands.
        private const int LeastFrames = 4;

        private const double RestMetres = 1e-4;
        private const double RestTurn = 1e-4;

        private readonly TipHistory history;
        private readonly RelativeVelocity relativeVelocity = new RelativeVelocity();
        private readonly SteppedPoses steps = new SteppedPoses();
        private readonly TipPath drawn = new TipPath(new TrackerNoise());
        private readonly TipPath stepped = new TipPath(new TrackerNoise());

        // Of the frames of the history: their frame of the surface, below 0 where it is not known, and the tip there.
        private readonly int[] frameOf = new int[TipHistory.Capacity];
        private readonly Double3[] steppedMetres = new Double3[TipHistory.Capacity];
        private bool isInWorld;
        private bool isStepped;

        public TouchedPath(TipHistory history) => this.history = history;

        public ContactBody? Surface { get; private set; }

        public TipVelocity Velocity
        {
            get
            {
                TipVelocity local = relativeVelocity.Of(isStepped ? stepped : drawn);
                if (isStepped && steps.IsEstimated)
                {
                    // As with a slow tracker, whose positions are as little dated.
                    local = new TipVelocity(local.ApproachMps, local.ApproachMps);
                }
                return isInWorld ? local : new TipVelocity(
                    Surface!.Track.Newest.DirectionToWorld(local.NowMps),
                    Surface.Track.Newest.DirectionToWorld(local.ApproachMps));
            }
        }

        public void Drop() => Surface = null;

        public void Pass(double nowSeconds) => drawn.Pass(nowSeconds);

        /// <summary>Adds a frame of a surface whose path goes on. Jumped where no hand makes the way.</summary>
        public TipStep Continue(double nowSeconds, Double3 tipMetres)
        {
            ContactBody surface = Surface!;
            PoseHistory track = surface.Track;
            bool isNear = track.Count == 0 ||
                nowSeconds - track.SecondsAt(track.Count - 1) < VelocitySettings.MinimumStepSeconds;
            if (!isNear)
            {
                Drop();
                return TipStep.Started;
            }
            bool hasOtherCoordinates = isInWorld != (track.Count == 0) || (!isInWorld && HasNewScale(track));
            if (hasOtherCoordinates)
            {
                Follow(surface);
                return TipStep.Continued;
            }
            Double3 local = isInWorld ? tipMetres : track.Newest.PointToLocal(tipMetres);
            TipStep step = drawn.Add(nowSeconds, local, tipMetres);
            return Judge() ?? step;
        }

        /// <summary>Makes the path over another surface, of the tip's last positions and of where the surface was
        /// then.</summary>
        public void Follow(ContactBody surface)
        {
            ContactBody? before = Surface != null && IsAtRestOn(surface, Surface) ? Surface : null;
            isStepped = isStepped && ReferenceEquals(surface, Surface);
            Surface = surface;
            isInWorld = surface.Track.Count == 0;
            drawn.Clear();
            for (int index = 0; index < history.Count; ++index)
            {
                double seconds = history.SecondsAt(index);
                Double3 tip = history.WorldMetresAt(index);
                if (TryToLocal(surface, before, seconds, tip, out Double3 local))
                {
                    drawn.Add(seconds, local, tip);
                }
            }
            Judge();
        }

        /// <summary>The tip at an earlier frame in the surface's coordinates of now. False where the surface was not
        /// known then.</summary>
        private static bool TryToLocal(
            ContactBody surface, ContactBody? before, double seconds, Double3 tip, out Double3 local)
        {
            local = tip;
            PoseHistory track = surface.Track;
            if (track.Count == 0)
            {
                return true;
            }
            int frame = track.IndexOf(seconds);
            if (frame >= 0)
            {
                local = Rescaled(track.PoseAt(frame).PointToLocal(tip), track.ScaleAt(frame), track.NewestScale);
                return true;
            }
            int earlier = before?.Track.IndexOf(seconds) ?? -1;
            if (earlier >= 0)
            {
                Double3 onBefore = before!.Track.PoseAt(earlier).PointToLocal(tip);
                local = track.Newest.PointToLocal(before.Track.Newest.PointToWorld(onBefore));
            }
            return earlier >= 0;
        }

        /// <summary>Whether a surface has not moved relative to the one before while both are known, so that the path
        /// over that one is one over this.</summary>
        private static bool IsAtRestOn(ContactBody surface, ContactBody before)
        {
            PoseHistory track = surface.Track;
            int earlier = track.Count < 2 ? -1 : before.Track.IndexOf(track.SecondsAt(0));
            if (earlier < 0 || ReferenceEquals(surface, before))
            {
                return false;
            }
            ref readonly RigidPose then = ref before.Track.PoseAt(earlier);
            ref readonly RigidPose now = ref before.Track.Newest;
            Double3 moved = then.PointToLocal(track.PoseAt(0).PositionMetres) -
                now.PointToLocal(track.Newest.PositionMetres);
            Double3 turned = then.DirectionToLocal(track.PoseAt(0).DirectionToWorld(new Double3(1.0, 1.0, -1.0))) -
                now.DirectionToLocal(track.Newest.DirectionToWorld(new Double3(1.0, 1.0, -1.0)));
            return moved.Length < RestMetres && turned.Length < RestTurn;
        }

        private static bool HasNewScale(PoseHistory track) =>
            track.Count > 1 && !track.NewestScale.Equals(track.ScaleAt(track.Count - 2));

        private static Double3 Rescaled(Double3 local, Double3 then, Double3 now) => then.Equals(now)
            ? local
            : new Double3(Rescaled(local.X, then.X, now.X), Rescaled(local.Y, then.Y, now.Y),
                Rescaled(local.Z, then.Z, now.Z));

        private static double Rescaled(double local, double then, double now) =>
            then * now > 1e-12 || then * now < -1e-12 ? local * (now / then) : local;

        /// <summary>Decides which path is the tip's. The newest step on the stepped path if it is that one; null
        /// otherwise.</summary>
        private TipStep? Judge()
        {
            PoseHistory track = Surface!.Track;
            isStepped = !isInWorld && track.Moves && history.Count > 0 && HasSmootherSteps(track);
            if (!isStepped)
            {
                return null;
            }
            stepped.Clear();
            TipStep step = TipStep.Started;
            for (int index = 0; index < history.Count; ++index)
            {
                if (frameOf[index] >= 0)
                {
                    step = stepped.Add(history.SecondsAt(index), steppedMetres[index], history.WorldMetresAt(index));
                }
            }
            return step;
        }

        private bool HasSmootherSteps(PoseHistory track)
        {
            Double3 tipNow = history.WorldMetresAt(history.Count - 1);
            if (!steps.Find(track, track.Newest.PointToLocal(tipNow)))
            {
                return false;
            }
            double sinceSeconds = history.SecondsAt(history.Count - 1) - WindowSeconds;
            var drawnMotion = new Roughness();
            var steppedMotion = new Roughness();
            for (int index = 0; index < history.Count; ++index)
            {
                double seconds = history.SecondsAt(index);
                int frame = seconds < steps.FirstSeconds ? -1 : track.IndexOf(seconds);
                frameOf[index] = frame;
                if (frame < 0)
                {
                    continue;
                }
                Double3 tip = history.WorldMetresAt(index);
                steppedMetres[index] = steps.PoseAt(seconds).PointToLocal(tip);
                if (seconds >= sinceSeconds)
                {
                    drawnMotion.Add(seconds, track.PoseAt(frame).PointToLocal(tip));
                    steppedMotion.Add(seconds, steppedMetres[index]);
                }
            }
            if (drawnMotion.Count < LeastFrames)
            {
                return isStepped;
            }
            double least = LeastMps * LeastMps * drawnMotion.Count;
            double asDrawn = drawnMotion.Squares + least;
            double bySteps = steppedMotion.Squares + least;
            // Between two that are as smooth nothing changes.
            return isStepped ? asDrawn >= Better * bySteps : bySteps < Better * asDrawn;
        }
    }

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

        public int Count { get; private set; }

        /// <summary>True where the pose has changed lately. A surface at rest costs nothing.</summary>
        public bool Moves => Count > 0 && SecondsAt(Count - 1) - changedSeconds <= RestSeconds;

        /// <summary>The pose of the newest frame; there must be one.</summary>
        public ref readonly RigidPose Newest => ref PoseAt(Count - 1);

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
            if (Count == 0 || timeSeconds - SecondsAt(Count - 1) >= VelocitySettings.MinimumStepSeconds)
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

        private int Slot(int index) => (oldest + index) % Capacity;
    }

    /// <summary>The tip's last positions in the world, of which the path over a surface is made when the tip comes to
    /// it. Whether a step is a jump only a surface can tell.</summary>
    internal sealed class TipHistory
    {
        public const int Capacity = 64;

        private readonly double[] timesSeconds = new double[Capacity];
        private readonly Double3[] worldMetres = new Double3[Capacity];
        private int oldest;
        private double latestSeconds;

        public int Count { get; private set; }

        public double SecondsAt(int index) => timesSeconds[(oldest + index) % Capacity];

        public Double3 WorldMetresAt(int index) => worldMetres[(oldest + index) % Capacity];

        public void Clear()
        {
            Count = 0;
            oldest = 0;
        }

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
            else if (Count > 0 && nowSeconds - latestSeconds > VelocitySettings.MaximumGapSeconds)
            {
                step = TipStep.Resumed;
            }
            if (step != TipStep.Continued)
            {
                Clear();
            }
            latestSeconds = nowSeconds;
            if (Count > 0 && nowSeconds - SecondsAt(Count - 1) < VelocitySettings.MinimumStepSeconds)
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
