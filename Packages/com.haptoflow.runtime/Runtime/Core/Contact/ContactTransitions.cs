#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>What a tip met between two frames.</summary>
    internal readonly struct ContactEvent
    {
        /// <summary>On another surface, or on another face of the same, with speed into it.</summary>
        public readonly bool Landed;

        /// <summary>Of an edge that the tip crossed; 0 for none.</summary>
        public readonly double EdgeHeightMetres;

        public ContactEvent(bool landed, double edgeHeightMetres)
        {
            Landed = landed;
            EdgeHeightMetres = edgeHeightMetres;
        }
    }

    /// <summary>Tells landings and edges from smooth sliding while a tip goes on touching. No garbage.</summary>
    /// <remarks>A face changes where the normal turns by 40 degrees over a short way, as it does over the rim of a box
    /// and not over a ball in the hand. A tip that moves into the new face lands on it; one that does not has crossed
    /// an edge: a rim, which is as high as the tip's radius since that far the tip can fall, or the step between two
    /// surfaces that lie one beside the other. Surfaces that are flush have neither. A hand that nothing holds presses deep
    /// into things, and deep inside two blocks side by side their inner faces are the nearest: so a change is judged where
    /// the tip would rest on the face that it was on (<see cref="RestingTip"/>).</remarks>
    internal sealed class ContactTransitions
    {
        /// <summary>A tip that moves more slowly into a face slides over to it.</summary>
        public const double LandingSpeedMps = 0.03;

        /// <summary>A tip that is further away a frame later has not slid off but jumped.</summary>
        public const double SlideOffReachMetres = 0.05;

        // The cosine of 40 degrees: surfaces of eight sides have edges, rounder ones do not.
        private const double FaceCosine = 0.766;

        // A lower step is none: tracking and meshes are no more exact.
        private const double MinimumStepMetres = 0.0001;

        // Of the rim under a tip of any radius.
        private const double MinimumRimMetres = 0.0005;

        // The reference stays behind by this way, and by the longer one, for a few frames, while the normal turns: a
        // slow tip that rolls over a rim turns by little from frame to frame, and a fast one may be seen in the middle
        // of it.
        private const double ShortWayMetres = 0.002;
        private const double LongWayMetres = 0.006;
        private const int MaximumFramesBehind = 2;

        // The cosine of 5 degrees.
        private const double SteadyCosine = 0.9962;

        // Places on the two faces of a rim lie below each other's planes but for rounding and a mesh's unevenness.
        private const double FlatnessMetres = 0.0001;

        private TrackedSurface? referenceSurface;
        private Double3 referencePoint;
        private Double3 referenceNormal;

        // Where the reference was before, on the same surface.
        private bool hasEarlier;
        private Double3 earlierPoint;
        private Double3 earlierNormal;

        // One rim is one edge, however slowly the tip rolls over it.
        private bool isArmed;

        // Frames that the reference has stayed behind by the long way.
        private int framesBehind;

        /// <summary>The next place compares with nothing.</summary>
        public void Forget() => referenceSurface = null;

        /// <summary>The surface is gone.</summary>
        public void Release(TrackedSurface surface)
        {
            if (ReferenceEquals(referenceSurface, surface))
            {
                Forget();
            }
        }

        /// <summary>The reference is on this surface.</summary>
        public bool IsOn(TrackedSurface surface) => ReferenceEquals(referenceSurface, surface);

        /// <summary>A place is on another surface than the reference, or its normal leans away from that of the
        /// reference.</summary>
        public bool IsElsewhere(in ContactCandidate now, double nowSeconds) => referenceSurface != null &&
            (!ReferenceEquals(referenceSurface, now.Surface) ||
             Double3.Dot(ReferencePlace(now, nowSeconds).Normal, new Place(now).Normal) < SteadyCosine);

        /// <summary>The tip's centre, raised out of the face of the reference until it just touches that.</summary>
        public Double3 RestingTip(in ContactCandidate now, Double3 tipMetres, double tipRadiusMetres, double nowSeconds)
        {
            if (referenceSurface == null)
            {
                return tipMetres;
            }
            Place before = ReferencePlace(now, nowSeconds);
            return tipMetres + Math.Max(0.0, tipRadiusMetres - before.HeightOf(tipMetres)) * before.Normal;
        }

        /// <summary>A resting tip that goes over a rim falls onto a place of another surface: then the rim is none, and
        /// what there is to feel is the step, once the tip is on that surface.</summary>
        public bool IsCaughtBy(in ContactCandidate other, in ContactCandidate now, Double3 restingTipMetres,
            double tipRadiusMetres, double nowSeconds)
        {
            var there = new Place(other);
            return referenceSurface != null && there.HeightOf(restingTipMetres) <= 2.0 * tipRadiusMetres &&
                !IsTurned(ReferencePlace(now, nowSeconds), there);
        }

        /// <summary>The tip touches a place, moving into it at a speed; where it is elsewhere, as a resting tip would.
        /// </summary>
        public ContactEvent Advance(
            in ContactCandidate now, double tipRadiusMetres, double nowSeconds, double approachSpeedMps)
        {
            if (referenceSurface == null)
            {
                MoveReference(now, true);
                return default;
            }
            Place before = ReferencePlace(now, nowSeconds);
            var here = new Place(now);
            if (IsFacing(before, here, tipRadiusMetres))
            {
                return default;
            }
            bool turned = IsTurned(before, here);
            bool isOther = !ReferenceEquals(referenceSurface, now.Surface);
            double step = StepBetween(before, here);
            bool landed = false;
            double height = 0.0;
            if (turned || (isOther && step >= MinimumStepMetres))
            {
                if (approachSpeedMps >= LandingSpeedMps)
                {
                    landed = true;
                }
                else if (!turned)
                {
                    height = step;
                }
                else if (isArmed && IsConvex(before, here))
                {
                    height = RimHeightMetres(tipRadiusMetres);
                }
            }
            bool isEvent = landed || height > 0.0;
            if (isEvent || isOther || IsToBeMoved(now, before, here))
            {
                MoveReference(now, !isEvent);
            }
            return new ContactEvent(landed, height);
        }

        /// <summary>The touch has ended: the height of the edge that the tip has slid off, 0 where it was lifted.
        /// </summary>
        /// <param name="nearest">The place of the touched surface nearest to the tip.</param>
        /// <param name="heightMetres">A tip that is no higher above the face that it was on has slid off it.</param>
        public double SlideOff(in ContactCandidate nearest, Double3 tipMetres, double tipRadiusMetres, double nowSeconds,
            double heightMetres)
        {
            if (!isArmed || !ReferenceEquals(referenceSurface, nearest.Surface))
            {
                return 0.0;
            }
            Place before = ReferencePlace(nearest, nowSeconds);
            var here = new Place(nearest);
            double above = before.HeightOf(tipMetres);
            if (hasEarlier)
            {
                // A fast tip may have been seen on the rim itself, where the normal leans outwards.
                var earlier = new Place(nearest.Pose, earlierPoint, earlierNormal);
                above = Math.Min(above, earlier.HeightOf(tipMetres));
            }
            bool isLow = above - tipRadiusMetres <= heightMetres;
            bool isNear = Double3.Distance(tipMetres, here.Point) - tipRadiusMetres <= SlideOffReachMetres;
            return isLow && isNear && IsTurned(before, here) ? RimHeightMetres(tipRadiusMetres) : 0.0;
        }

        private static bool IsTurned(in Place before, in Place here) =>
            Double3.Dot(before.Normal, here.Normal) < FaceCosine;

        /// <summary>Two faces that look at each other across less than the tip's width: no tip comes from one to the
        /// other.</summary>
        private static bool IsFacing(in Place before, in Place here, double tipRadiusMetres)
        {
            double gap = before.HeightOf(here.Point);
            return Double3.Dot(before.Normal, here.Normal) < -FaceCosine && gap >= -FlatnessMetres &&
                gap <= Math.Max(2.0 * tipRadiusMetres, MinimumRimMetres);
        }

        private static bool IsConvex(in Place before, in Place here) =>
            before.HeightOf(here.Point) <= FlatnessMetres && here.HeightOf(before.Point) <= FlatnessMetres;

        /// <summary>Where a surface curves, each of two places lies as far below the other's plane; over a step one lies
        /// above.</summary>
        private static double StepBetween(in Place before, in Place here) =>
            0.5 * Math.Abs(before.HeightOf(here.Point) - here.HeightOf(before.Point));

        private static double RimHeightMetres(double tipRadiusMetres) => Math.Max(tipRadiusMetres, MinimumRimMetres);

        private Place ReferencePlace(in ContactCandidate now, double nowSeconds)
        {
            bool isSame = ReferenceEquals(referenceSurface, now.Surface) || referenceSurface!.Track.Count == 0;
            RigidPose pose = isSame ? now.Pose : referenceSurface!.Track.PoseAt(nowSeconds);
            return new Place(pose, referencePoint, referenceNormal);
        }

        private bool IsToBeMoved(in ContactCandidate now, in Place before, in Place here)
        {
            // On one surface the way is that over it, whatever its own motion.
            double way = Double3.Distance(now.Local.PointMetres, referencePoint);
            bool isSteady = Double3.Dot(before.Normal, here.Normal) > SteadyCosine;
            if (way > ShortWayMetres && (isSteady || !isArmed))
            {
                return true;
            }
            // On a round surface each of two places lies as far below the other's plane, in the middle of a rim it does
            // not.
            bool isRound = StepBetween(before, here) < MinimumStepMetres;
            return way > LongWayMetres && (isRound || ++framesBehind > MaximumFramesBehind);
        }

        private void MoveReference(in ContactCandidate now, bool armed)
        {
            hasEarlier = ReferenceEquals(referenceSurface, now.Surface);
            earlierPoint = referencePoint;
            earlierNormal = referenceNormal;
            framesBehind = 0;
            referenceSurface = now.Surface;
            referencePoint = now.Local.PointMetres;
            referenceNormal = now.Local.Normal;
            isArmed = armed;
        }

        /// <summary>In world space.</summary>
        private readonly struct Place
        {
            public readonly Double3 Point;
            public readonly Double3 Normal;

            public Place(in ContactCandidate candidate)
                : this(candidate.Pose, candidate.Local.PointMetres, candidate.Local.Normal)
            {
            }

            public Place(in RigidPose pose, Double3 localPoint, Double3 localNormal)
            {
                Point = pose.PointToWorld(localPoint);
                Normal = pose.DirectionToWorld(localNormal);
            }

            public double HeightOf(Double3 point) => Double3.Dot(point - Point, Normal);
        }
    }
}
