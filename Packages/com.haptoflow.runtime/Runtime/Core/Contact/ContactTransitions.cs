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
    /// surfaces that lie one beside the other. Surfaces that are flush have neither.</remarks>
    internal sealed class ContactTransitions
    {
        /// <summary>A tip that moves more slowly into a face slides over to it.</summary>
        public const double LandingSpeedMps = 0.03;

        /// <summary>A tip that is further away a frame later has not slid off but jumped.</summary>
        public const double SlideOffReachMetres = 0.05;

        // The cosine of 40 degrees: surfaces of eight sides have edges, rounder ones do not.
        private const double FaceCosine = 0.766;

        // A lower step is none: tracking and meshes are no more exact.
        private const double LowestStepMetres = 0.0001;

        // Of the rim under a tip of any radius.
        private const double LowestRimMetres = 0.0005;

        // The reference stays behind by this way, and by the longer one while the normal turns: a slow tip that rolls
        // over a rim turns by little from frame to frame.
        private const double ShortWayMetres = 0.002;
        private const double LongWayMetres = 0.006;

        // The cosine of 5 degrees.
        private const double SteadyCosine = 0.9962;

        // Places on the two faces of a rim lie below each other's planes but for rounding and a mesh's unevenness.
        private const double FlatnessMetres = 0.0001;

        private TrackedSurface? referenceSurface;
        private Double3 referencePoint;
        private Double3 referenceNormal;

        // One rim is one edge, however slowly the tip rolls over it.
        private bool isArmed;

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

        /// <summary>The tip touches a place, moving into it at a speed.</summary>
        public ContactEvent Advance(
            in ContactCandidate now, double tipRadiusMetres, double nowSeconds, double approachSpeedMps)
        {
            if (referenceSurface == null)
            {
                MoveReference(now, true);
                return default;
            }
            Place before = ReferencePlace(now, nowSeconds);
            var here = new Place(now.Pose, now.Local.PointMetres, now.Local.Normal);
            bool turned = IsTurned(before, here);
            bool isOther = !ReferenceEquals(referenceSurface, now.Surface);
            double step = StepBetween(before, here);
            bool landed = false;
            double height = 0.0;
            if (turned || (isOther && step >= LowestStepMetres))
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
            if (landed || height > 0.0)
            {
                MoveReference(now, false);
            }
            else if (IsFarEnough(now, isOther, Double3.Dot(before.Normal, here.Normal) > SteadyCosine))
            {
                MoveReference(now, true);
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
            var here = new Place(nearest.Pose, nearest.Local.PointMetres, nearest.Local.Normal);
            bool isLow = before.HeightOf(tipMetres) - tipRadiusMetres <= heightMetres;
            bool isNear = Double3.Distance(tipMetres, here.Point) - tipRadiusMetres <= SlideOffReachMetres;
            return isLow && isNear && IsTurned(before, here) ? RimHeightMetres(tipRadiusMetres) : 0.0;
        }

        private static bool IsTurned(in Place before, in Place here) =>
            Double3.Dot(before.Normal, here.Normal) < FaceCosine;

        private static bool IsConvex(in Place before, in Place here) =>
            before.HeightOf(here.Point) <= FlatnessMetres && here.HeightOf(before.Point) <= FlatnessMetres;

        /// <summary>Where a surface curves, each of two places lies as far below the other's plane; over a step one lies
        /// above.</summary>
        private static double StepBetween(in Place before, in Place here) =>
            0.5 * Math.Abs(before.HeightOf(here.Point) - here.HeightOf(before.Point));

        private static double RimHeightMetres(double tipRadiusMetres) => Math.Max(tipRadiusMetres, LowestRimMetres);

        private Place ReferencePlace(in ContactCandidate now, double nowSeconds)
        {
            bool isSame = ReferenceEquals(referenceSurface, now.Surface) || referenceSurface!.Track.Count == 0;
            RigidPose pose = isSame ? now.Pose : referenceSurface!.Track.PoseAt(nowSeconds);
            return new Place(pose, referencePoint, referenceNormal);
        }

        private bool IsFarEnough(in ContactCandidate now, bool isOther, bool isSteady)
        {
            // On one surface the way is that over it, whatever its own motion.
            double way = isOther ? LongWayMetres : Double3.Distance(now.Local.PointMetres, referencePoint);
            return way >= LongWayMetres || (way > ShortWayMetres && isSteady);
        }

        private void MoveReference(in ContactCandidate now, bool armed)
        {
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

            public Place(in RigidPose pose, Double3 localPoint, Double3 localNormal)
            {
                Point = pose.PointToWorld(localPoint);
                Normal = pose.DirectionToWorld(localNormal);
            }

            public double HeightOf(Double3 point) => Double3.Dot(point - Point, Normal);
        }
    }
}
