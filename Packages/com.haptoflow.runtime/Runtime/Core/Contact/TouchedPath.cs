#nullable enable
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
        private readonly SteppedPoses steps;
        private readonly TipPath drawn;
        private readonly TipPath stepped;

        // Of the frames of the history: their frame of the surface, below 0 where it is not known, and the tip there.
        private readonly int[] frameOf = new int[TipHistory.Capacity];
        private readonly Double3[] steppedMetres = new Double3[TipHistory.Capacity];
        private bool isInWorld;
        private bool isStepped;

        public TouchedPath(VelocitySettings settings, TipHistory history)
        {
            this.history = history;
            steps = new SteppedPoses(settings);
            drawn = new TipPath(settings, new TrackerNoise());
            stepped = new TipPath(settings, new TrackerNoise());
        }

        /// <summary>The surface of the path; null without one.</summary>
        public ContactBody? Surface { get; private set; }

        /// <summary>The velocity in world axes.</summary>
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

        /// <summary>Advances the clock without a measurement, so that the time until the next one is no
        /// pause.</summary>
        public void Pass(double nowSeconds) => drawn.Pass(nowSeconds);

        /// <summary>Adds a frame of a surface whose path goes on. Jumped where no hand makes the way.</summary>
        public TipStep Continue(double nowSeconds, Double3 tipMetres)
        {
            ContactBody surface = Surface!;
            PoseHistory track = surface.Track;
            bool isNear = track.Count == 0 ||
                nowSeconds - track.SecondsAt(track.Count - 1) < drawn.Settings.MinimumStepSeconds;
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
}
