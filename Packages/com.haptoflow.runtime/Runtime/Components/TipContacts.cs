#nullable enable
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow
{
    /// <summary>The colliders around one tip, frame by frame: queries the physics engine, keeps the colliders that are
    /// near, and lets the contact model decide which one is touched. Main thread, no garbage after
    /// construction.</summary>
    internal sealed class TipContacts : IContactGeometry
    {
        private const int MaximumColliders = 128;
        private const int MaximumNearbyColliders = 32;

        // Colliders are tracked before they are touched, so that their velocity is known at touch-down.
        private const double TrackedWithinMetres = 0.05;

        // With too many colliders, those within this distance have priority.
        private const double TouchableWithinMetres = 0.003;

        private readonly Transform stylus;
        private readonly Collider[] colliders = new Collider[MaximumColliders];
        private readonly NearbyCollider[] near = new NearbyCollider[MaximumNearbyColliders];
        private bool hasTooMany;
        private bool hasWarned;
        private long update;

        /// <param name="stylus">The stylus, whose own colliders the rules must not match.</param>
        public TipContacts(ContactSettings settings, double tipRadiusMetres, Transform stylus)
        {
            this.stylus = stylus;
            Tracker = new ContactTracker(settings, tipRadiusMetres) { Geometry = this };
            for (int index = 0; index < near.Length; ++index)
            {
                near[index] = new NearbyCollider();
            }
        }

        public ContactTracker Tracker { get; }

        /// <summary>The collider that <see cref="Update"/> found touched; null without a touch.</summary>
        public NearbyCollider? Touched { get; private set; }

        /// <param name="stepSeconds">Time of the last physics step, on the sample's clock.</param>
        public ContactReading Update(
            in TipSample sample, double stepSeconds, int layers, HapticSession session, Object context)
        {
            ++update;
            if (Tracker.BeginFrame(sample))
            {
                Consider(stepSeconds, layers, session, context);
            }
            ContactReading reading = Tracker.EndFrame();
            Touched = Find(reading.Surface);
            ReleaseDistant();
            return reading;
        }

        public void Forget()
        {
            Tracker.Forget();
            Touched = null;
            foreach (NearbyCollider surface in near)
            {
                surface.End();
            }
        }

        bool IContactGeometry.TryClosest(ContactBody surface, Double3 tipMetres, out SurfacePoint found)
        {
            found = default;
            NearbyCollider? place = Find(surface);
            if (place == null || place.Collider == null)
            {
                return false;
            }
            using FrontFacesOnly fronts = FrontFacesOnly.Begin();
            var question = new ProbeQuestion(
                tipMetres, Tracker.TipRadiusMetres + ContactTransitions.SlideOffReachMetres,
                Tracker.HeldFaceOf(surface));
            bool isNear = ColliderProbe.TryClosest(
                place.Collider, ColliderProbe.PoseOf(place.Collider), question, out ProbeAnswer answer);
            found = answer.Point;
            return isNear;
        }

        private void Consider(double stepSeconds, int layers, HapticSession session, Object context)
        {
            using FrontFacesOnly fronts = FrontFacesOnly.Begin();
            if (hasTooMany)
            {
                // Colliders that the tip may touch take precedence over those that are only tracked.
                ConsiderWithin(Tracker.ReachMetres + TouchableWithinMetres, stepSeconds, layers, session, true);
            }
            bool hasAll = ConsiderWithin(
                Tracker.ReachMetres + TrackedWithinMetres, stepSeconds, layers, session, false);
            hasTooMany = !hasAll;
            if (Tracker.PassedWithinMetres > TrackedWithinMetres)
            {
                // With slow frames a hand comes from farther away, and passes what is then far behind it.
                ConsiderWithin(Tracker.ReachMetres + Tracker.PassedWithinMetres, stepSeconds, layers, session, false);
            }
            if (hasTooMany)
            {
                WarnTooManyColliders(context);
            }
        }

        /// <param name="takesPlaces">True to replace colliders that this update has not found near.</param>
        /// <returns>False where there was no room for some.</returns>
        private bool ConsiderWithin(
            double metres, double stepSeconds, int layers, HapticSession session, bool takesPlaces)
        {
            // A scene may have been loaded with a physics world of its own, of which Physics knows nothing.
            int count = stylus.gameObject.scene.GetPhysicsScene().OverlapSphere(
                Tracker.TipMetres.ToVector(), (float)metres, colliders, layers, QueryTriggerInteraction.Ignore);
            bool hasAll = count < colliders.Length;
            for (int index = 0; index < count; ++index)
            {
                Collider collider = colliders[index];
                HapticSurface? surface = SurfaceOf(collider);
                MappedCollider? byRules = surface is object || IsOfStylus(collider)
                    ? null
                    : MappedColliders.Resolve(collider);
                if (surface is object || byRules is object)
                {
                    NearbyCollider? place = PlaceFor(collider, surface, byRules, takesPlaces);
                    hasAll &= place != null;
                    if (place != null && place.LastUpdate != update)
                    {
                        Consider(place, collider, stepSeconds, session);
                    }
                }
                colliders[index] = null!;
            }
            return hasAll;
        }

        private void Consider(NearbyCollider place, Collider collider, double stepSeconds, HapticSession session)
        {
            place.LastUpdate = update;
            RigidPose pose = ColliderProbe.PoseOf(collider);
            place.Record(Tracker.NowSeconds, stepSeconds, pose);
            var question = new ProbeQuestion(
                Tracker.TipMetres, Tracker.ReachMetresOf(place.Tracked), Tracker.HeldFaceOf(place.Tracked),
                Tracker.AdvancePath(place.Tracked, pose));
            if (ColliderProbe.TryClosest(collider, pose, question, out ProbeAnswer answer))
            {
                place.Place = new TouchedPlace(collider, answer.Point.PointMetres, answer.Hit);
                place.Tracked.StiffnessNewtonsPerMetre = place.Feel(session).StiffnessNewtonsPerMetre;
                Tracker.Consider(new ContactCandidate(place.Tracked, pose, answer.Point, answer.EntryShare));
            }
        }

        /// <summary>Looks the surface up again when a collider comes near, and when the surface that it belonged to
        /// changed.</summary>
        private HapticSurface? SurfaceOf(Collider collider)
        {
            foreach (NearbyCollider each in near)
            {
                if (ReferenceEquals(each.Collider, collider) && each.Surface is object &&
                    SurfaceRegistry.Holds(collider, each.Surface))
                {
                    return each.Surface;
                }
            }
            return SurfaceRegistry.Resolve(collider);
        }

        /// <summary>Frees the entry of a collider that is not touched and that this update has not found
        /// near.</summary>
        private NearbyCollider? ReusableEntry()
        {
            foreach (NearbyCollider each in near)
            {
                if (each.LastUpdate != update && !ReferenceEquals(each.Tracked, Tracker.Touched))
                {
                    Tracker.Release(each.Tracked);
                    each.End();
                    return each;
                }
            }
            return null;
        }

        /// <summary>True for a collider of the stylus itself or of the body that carries it, which a broad rule may
        /// match but the stylus must not touch.</summary>
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

        private NearbyCollider? PlaceFor(
            Collider collider, HapticSurface? surface, MappedCollider? byRules, bool takesPlaces)
        {
            NearbyCollider? free = null;
            foreach (NearbyCollider each in near)
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
                free = ReusableEntry();
            }
            free?.Begin(collider, surface, byRules);
            return free;
        }

        private NearbyCollider? Find(ContactBody? tracked)
        {
            if (tracked != null)
            {
                foreach (NearbyCollider each in near)
                {
                    if (ReferenceEquals(each.Tracked, tracked))
                    {
                        return each;
                    }
                }
            }
            return null;
        }

        private void ReleaseDistant()
        {
            foreach (NearbyCollider each in near)
            {
                if (!(each.Collider is null) && each.LastUpdate != update)
                {
                    Tracker.Release(each.Tracked);
                    each.End();
                }
            }
        }

        private void WarnTooManyColliders(Object context)
        {
            if (!hasWarned)
            {
                hasWarned = true;
                Debug.LogWarning($"HaptoFlow: more than {MaximumNearbyColliders} tagged colliders are within " +
                    $"{TrackedWithinMetres * 100.0:0} cm of a tip: those it touches are felt, but the velocity of " +
                    "moving ones is known late. Narrow the stylus's layer mask.", context);
            }
        }
    }
}
