#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>Distinguishes landings and edges from smooth sliding during a touch. No garbage.</summary>
    /// <remarks>A face changes where the normal turns by 40 degrees over a short distance, as it does over the rim of a
    /// box but not over a ball in the hand. A tip that moves into the new face lands on it; otherwise it has crossed an
    /// edge: a rim, as high as the tip's radius because the tip can fall that far, or the step between two adjacent
    /// surfaces. Flush surfaces have neither. A hand in the air presses deep into virtual objects, and deep inside two
    /// adjacent blocks their inner faces are the closest; a change is therefore judged where the tip would rest on its
    /// previous face (<see cref="RestingTip"/>).</remarks>
    internal sealed class ContactTransitions
    {
        /// <summary>Below this speed into a face the tip slides over to it without landing.</summary>
        public const double LandingSpeedMps = 0.03;

        /// <summary>A tip farther away than this one frame later has jumped, not slid off.</summary>
        public const double SlideOffReachMetres = 0.05;

        // The cosine of 40 degrees: an octagonal prism has edges, rounder shapes have none.
        private const double FaceCosine = 0.766;

        // Lower steps are ignored: tracking and meshes are not more accurate.
        private const double MinimumStepMetres = 0.0001;

        // Minimum height of a rim, for a tip of any radius.
        private const double MinimumRimMetres = 0.0005;

        // While the normal turns, the reference point stays behind by the short distance, and for a few frames by the
        // long one. A slow tip that rolls over a rim turns little from frame to frame, and a fast one may be sampled on
        // the rim.
        private const double ShortDistanceMetres = 0.002;
        private const double LongDistanceMetres = 0.006;
        private const int MaximumFramesBehind = 2;

        // The cosine of 5 degrees.
        private const double SteadyCosine = 0.9962;

        // Points on the two faces of a rim lie below each other's planes, up to rounding and unevenness of the mesh.
        private const double FlatnessMetres = 0.0001;

        private ContactBody? referenceSurface;
        private Double3 referencePoint;
        private Double3 referenceNormal;

        // The previous reference on the same surface.
        private bool hasEarlier;
        private Double3 earlierPoint;
        private Double3 earlierNormal;

        // Set after an edge: however slowly the tip rolls over a rim, it is one edge.
        private bool isArmed;

        // Frames for which the reference has stayed behind by the long distance.
        private int framesBehind;

        /// <summary>Discards the reference: the next point is not compared.</summary>
        public void Forget() => referenceSurface = null;

        public void Release(ContactBody surface)
        {
            if (ReferenceEquals(referenceSurface, surface))
            {
                Forget();
            }
        }

        public bool IsOn(ContactBody surface) => ReferenceEquals(referenceSurface, surface);

        /// <summary>True for a point on another surface than the reference, or with a normal that differs from the
        /// reference's.</summary>
        public bool IsElsewhere(in ContactCandidate now, double nowSeconds) => referenceSurface != null &&
            (!ReferenceEquals(referenceSurface, now.Surface) ||
             Double3.Dot(ReferencePlace(now, nowSeconds).Normal, new Place(now).Normal) < SteadyCosine);

        /// <summary>The tip's centre, raised along the reference's normal until the tip just touches the reference's
        /// face.</summary>
        public Double3 RestingTip(in ContactCandidate now, Double3 tipMetres, double tipRadiusMetres, double nowSeconds)
        {
            if (referenceSurface == null)
            {
                return tipMetres;
            }
            Place before = ReferencePlace(now, nowSeconds);
            return tipMetres + Math.Max(0.0, tipRadiusMetres - before.HeightOf(tipMetres)) * before.Normal;
        }

        /// <summary>True where a resting tip that crosses a rim falls onto another surface: the rim is then not felt,
        /// only the step once the tip is on that surface.</summary>
        public bool IsCaughtBy(in ContactCandidate other, in ContactCandidate now, Double3 restingTipMetres,
            double tipRadiusMetres, double nowSeconds)
        {
            var there = new Place(other);
            return referenceSurface != null && there.HeightOf(restingTipMetres) <= 2.0 * tipRadiusMetres &&
                !IsTurned(ReferencePlace(now, nowSeconds), there);
        }

        /// <summary>Compares a touched point with the reference and advances the reference. A candidate elsewhere must
        /// be that of the resting tip.</summary>
        /// <returns>True after a landing on another surface, or on another face of the same one, with speed into it; the
        /// height of the edge that the tip crossed, 0 for none.</returns>
        public (bool Landed, double EdgeHeightMetres) Advance(
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
            if (isEvent || isOther || MustMoveReference(now, before, here))
            {
                MoveReference(now, !isEvent);
            }
            return (landed, height);
        }

        /// <summary>After the end of a touch: the height of the edge that the tip slid off, 0 for a lift-off.</summary>
        /// <param name="nearest">The point of the touched surface closest to the tip.</param>
        /// <param name="heightMetres">A tip at most this high above its last face has slid off it.</param>
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
                // A fast tip may have been sampled on the rim itself, where the normal points outwards.
                var earlier = new Place(nearest.Pose, earlierPoint, earlierNormal);
                above = Math.Min(above, earlier.HeightOf(tipMetres));
            }
            bool isLow = above - tipRadiusMetres <= heightMetres;
            bool isNear = Double3.Distance(tipMetres, here.Point) - tipRadiusMetres <= SlideOffReachMetres;
            return isLow && isNear && IsTurned(before, here) ? RimHeightMetres(tipRadiusMetres) : 0.0;
        }

        private static bool IsTurned(in Place before, in Place here) =>
            Double3.Dot(before.Normal, here.Normal) < FaceCosine;

        /// <summary>True for two faces that face each other across less than the tip's width: the tip cannot pass from
        /// one to the other.</summary>
        private static bool IsFacing(in Place before, in Place here, double tipRadiusMetres)
        {
            double gap = before.HeightOf(here.Point);
            return Double3.Dot(before.Normal, here.Normal) < -FaceCosine && gap >= -FlatnessMetres &&
                gap <= Math.Max(2.0 * tipRadiusMetres, MinimumRimMetres);
        }

        private static bool IsConvex(in Place before, in Place here) =>
            before.HeightOf(here.Point) <= FlatnessMetres && here.HeightOf(before.Point) <= FlatnessMetres;

        /// <summary>Height of a step. On a curved surface each of two points lies equally far below the other's plane;
        /// at a step one lies above.</summary>
        private static double StepBetween(in Place before, in Place here) =>
            0.5 * Math.Abs(before.HeightOf(here.Point) - here.HeightOf(before.Point));

        private static double RimHeightMetres(double tipRadiusMetres) => Math.Max(tipRadiusMetres, MinimumRimMetres);

        private Place ReferencePlace(in ContactCandidate now, double nowSeconds)
        {
            bool isSame = ReferenceEquals(referenceSurface, now.Surface) || referenceSurface!.Track.Count == 0;
            RigidPose pose = isSame ? now.Pose : referenceSurface!.Track.Newest;
            return new Place(pose, referencePoint, referenceNormal);
        }

        private bool MustMoveReference(in ContactCandidate now, in Place before, in Place here)
        {
            // On one surface the distance is measured in its local frame, so that its own motion does not count.
            double distance = Double3.Distance(now.Local.PointMetres, referencePoint);
            bool isSteady = Double3.Dot(before.Normal, here.Normal) > SteadyCosine;
            if (distance > ShortDistanceMetres && (isSteady || !isArmed))
            {
                return true;
            }
            // On a round surface each of two points lies equally far below the other's plane; on a rim it does not.
            bool isRound = StepBetween(before, here) < MinimumStepMetres;
            return distance > LongDistanceMetres && (isRound || ++framesBehind > MaximumFramesBehind);
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

        /// <summary>A contact point in world space.</summary>
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
