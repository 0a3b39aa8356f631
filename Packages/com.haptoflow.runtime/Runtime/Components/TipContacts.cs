#nullable enable
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;
using Object = UnityEngine.Object;

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

        // In a crowd: what is nearer than this gets a place before all else.
        private const double TouchableWithinMetres = 0.003;

        private readonly Transform stylus;
        private readonly Collider[] colliders = new Collider[MostColliders];
        private readonly NearbySurface[] near = new NearbySurface[MostSurfaces];
        private Double3 previousTipMetres;
        private bool hasPreviousTip;
        private bool isCrowded;
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
            if (isCrowded)
            {
                // What the tip may touch comes before what is only followed.
                ConsiderWithin(Tracker.ReachMetres + TouchableWithinMetres, stepSeconds, layers, session, true);
            }
            bool hasAll = ConsiderWithin(
                Tracker.ReachMetres + FollowedWithinMetres, stepSeconds, layers, session, false);
            isCrowded = !hasAll;
            if (isCrowded)
            {
                WarnOfCrowd(context);
            }
        }

        /// <param name="takesPlaces">Places of surfaces that were not met in this update are taken from them.</param>
        /// <returns>False where there was no room for some.</returns>
        private bool ConsiderWithin(
            double metres, double stepSeconds, int layers, HapticSession session, bool takesPlaces)
        {
            int count = Physics.OverlapSphereNonAlloc(
                Tracker.TipMetres.ToVector(), (float)metres, colliders, layers, QueryTriggerInteraction.Ignore);
            bool hasAll = count < colliders.Length;
            for (int index = 0; index < count; ++index)
            {
                Collider collider = colliders[index];
                HapticSurface? surface = SurfaceOf(collider);
                FeltCollider? byRules = surface is object || IsOfStylus(collider)
                    ? null
                    : FeltColliders.Resolve(collider);
                if (surface is object || byRules is object)
                {
                    NearbySurface? place = PlaceFor(collider, surface, byRules, takesPlaces);
                    hasAll &= place != null;
                    if (place != null && place.LastMet != update)
                    {
                        Consider(place, collider, stepSeconds, session);
                    }
                }
                colliders[index] = null!;
            }
            return hasAll;
        }

        private void Consider(NearbySurface place, Collider collider, double stepSeconds, HapticSession session)
        {
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

        /// <summary>A place whose surface the tip did not touch and that this update has not met.</summary>
        private NearbySurface? NotMetYet()
        {
            foreach (NearbySurface each in near)
            {
                if (each.LastMet != update && !ReferenceEquals(each.Tracked, Tracker.Touched))
                {
                    Tracker.Release(each.Tracked);
                    each.End();
                    return each;
                }
            }
            return null;
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

        private NearbySurface? PlaceFor(
            Collider collider, HapticSurface? surface, FeltCollider? byRules, bool takesPlaces)
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
            if (free == null && takesPlaces)
            {
                free = NotMetYet();
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
                    $"{FollowedWithinMetres * 100.0:0} cm of a tip: those it touches are felt, but the motion of one " +
                    "that moves is felt late. Narrow the stylus's layer mask.", context);
            }
        }
    }
}
