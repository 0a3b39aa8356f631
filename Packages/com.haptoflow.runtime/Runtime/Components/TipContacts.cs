#nullable enable
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The surfaces around one tip, frame by frame: asks the physics engine, keeps what is near, and lets the
    /// contact model decide. Main thread, no garbage after construction.</summary>
    internal sealed class TipContacts : ISurfaceGeometry
    {
        private const int MostColliders = 128;
        private const int MostSurfaces = 32;

        // Surfaces are followed before they are touched, so that a velocity relative to them is there at touch-down.
        private const double FollowedWithinMetres = 0.05;

        private readonly Transform stylus;
        private readonly Collider[] colliders = new Collider[MostColliders];
        private readonly NearbySurface[] near = new NearbySurface[MostSurfaces];
        private Double3 previousTipMetres;
        private bool hasPreviousTip;
        private bool warnedOfCrowd;
        private long update;

        /// <param name="stylus">Its own colliders are not felt by rules.</param>
        public TipContacts(ContactSettings settings, double tipRadiusMetres, Transform stylus)
        {
            this.stylus = stylus;
            Tracker = new ContactTracker(settings, tipRadiusMetres) { Geometry = this };
            for (int index = 0; index < near.Length; ++index)
            {
                near[index] = new NearbySurface();
            }
        }

        public ContactTracker Tracker { get; }

        /// <summary>What is touched after <see cref="Update"/>; null where nothing is.</summary>
        public NearbySurface? Touched { get; private set; }

        /// <param name="stepSeconds">Time of the last physics step, on the sample's clock.</param>
        public ContactReading Update(
            in TipSample sample, double stepSeconds, int layers, HapticSession session, Object context)
        {
            ++update;
            if (Tracker.BeginFrame(sample))
            {
                Consider(stepSeconds, layers, session, context);
                previousTipMetres = Tracker.TipMetres;
                hasPreviousTip = true;
            }
            ContactReading reading = Tracker.EndFrame();
            Touched = Find(reading.Surface);
            LetGoOfDistant();
            return reading;
        }

        public void Forget()
        {
            Tracker.Forget();
            Touched = null;
            hasPreviousTip = false;
            foreach (NearbySurface surface in near)
            {
                surface.End();
            }
        }

        bool ISurfaceGeometry.TryClosest(TrackedSurface surface, Double3 tipMetres, out SurfacePoint found)
        {
            found = default;
            NearbySurface? place = Find(surface);
            if (place == null || place.Collider == null)
            {
                return false;
            }
            using FrontFacesOnly fronts = FrontFacesOnly.Begin();
            var question = new ProbeQuestion(
                tipMetres, Tracker.TipRadiusMetres + ContactTransitions.SlideOffReachMetres,
                Tracker.PreviousLocalNormal(surface), tipMetres, Tracker.Settings.SwitchMarginMetres);
            return ColliderProbe.TryClosest(place.Collider, ColliderProbe.PoseOf(place.Collider), question, out found);
        }

        private void Consider(double stepSeconds, int layers, HapticSession session, Object context)
        {
            using FrontFacesOnly fronts = FrontFacesOnly.Begin();
            float radius = (float)(Tracker.ReachMetres + FollowedWithinMetres);
            int count = Physics.OverlapSphereNonAlloc(
                Tracker.TipMetres.ToVector(), radius, colliders, layers, QueryTriggerInteraction.Ignore);
            for (int index = 0; index < count; ++index)
            {
                Collider collider = colliders[index];
                HapticSurface? surface = SurfaceOf(collider);
                FeltCollider? byRules = surface is object || IsOfStylus(collider)
                    ? null
                    : FeltColliders.Resolve(collider);
                if (surface is object || byRules is object)
                {
                    Consider(collider, surface, byRules, stepSeconds, session, context);
                }
                colliders[index] = null!;
            }
        }

        private void Consider(
            Collider collider, HapticSurface? surface, FeltCollider? byRules, double stepSeconds, HapticSession session,
            Object context)
        {
            NearbySurface? place = PlaceFor(collider, surface, byRules);
            if (place == null)
            {
                WarnOfCrowd(context);
                return;
            }
            place.LastMet = update;
            RigidPose pose = ColliderProbe.PoseOf(collider);
            place.Record(Tracker.NowSeconds, stepSeconds, pose);
            var question = new ProbeQuestion(
                Tracker.TipMetres, Tracker.ReachMetresOf(place.Tracked), Tracker.PreviousLocalNormal(place.Tracked),
                hasPreviousTip ? previousTipMetres : Tracker.TipMetres, Tracker.Settings.SwitchMarginMetres);
            if (ColliderProbe.TryClosest(collider, pose, question, out SurfacePoint local, out RaycastHit? hit))
            {
                place.Place = new TouchedPlace(collider, local.PointMetres, hit);
                place.Tracked.StiffnessNewtonsPerMetre = place.Feel(session).StiffnessNewtonsPerMetre;
                Tracker.Consider(new ContactCandidate(place.Tracked, pose, local));
            }
        }

        /// <summary>Looked up anew when a collider comes near, and when something changed about the surface that it led
        /// to.</summary>
        private HapticSurface? SurfaceOf(Collider collider)
        {
            foreach (NearbySurface each in near)
            {
                if (ReferenceEquals(each.Collider, collider) && each.Surface is object &&
                    SurfaceRegistry.Holds(collider, each.Surface))
                {
                    return each.Surface;
                }
            }
            return SurfaceRegistry.Resolve(collider);
        }

        /// <summary>A pen must not feel itself, nor the body of who holds it, where a rule is wide enough to match
        /// them.</summary>
        private bool IsOfStylus(Collider collider)
        {
            if (!MaterialMaps.Any)
            {
                return false;
            }
            Rigidbody body = collider.attachedRigidbody!;
            return collider.transform.IsChildOf(stylus) ||
                (collider is CharacterController && stylus.IsChildOf(collider.transform)) ||
                (body != null && stylus.IsChildOf(body.transform));
        }

        private NearbySurface? PlaceFor(Collider collider, HapticSurface? surface, FeltCollider? byRules)
        {
            NearbySurface? free = null;
            foreach (NearbySurface each in near)
            {
                if (ReferenceEquals(each.Collider, collider) && ReferenceEquals(each.Surface, surface) &&
                    ReferenceEquals(each.ByRules, byRules))
                {
                    return each;
                }
                free = each.Collider is null ? each : free;
            }
            free?.Begin(collider, surface, byRules);
            return free;
        }

        private NearbySurface? Find(TrackedSurface? tracked)
        {
            if (tracked != null)
            {
                foreach (NearbySurface each in near)
                {
                    if (ReferenceEquals(each.Tracked, tracked))
                    {
                        return each;
                    }
                }
            }
            return null;
        }

        private void LetGoOfDistant()
        {
            foreach (NearbySurface each in near)
            {
                if (!(each.Collider is null) && each.LastMet != update)
                {
                    Tracker.Release(each.Tracked);
                    each.End();
                }
            }
        }

        private void WarnOfCrowd(Object context)
        {
            if (!warnedOfCrowd)
            {
                warnedOfCrowd = true;
                Debug.LogWarning($"HaptoFlow: more than {MostSurfaces} colliders that can be felt within " +
                    $"{FollowedWithinMetres * 100.0:0} cm of a tip; some are not felt. " +
                    "Narrow the stylus's layer mask.", context);
            }
        }
    }
}
