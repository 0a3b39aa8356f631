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
        private const int MaximumNearbyColliders = 32;

        // Colliders are tracked before they are touched, so that the tip's path over them is known at touch-down.
        private const double TrackedWithinMetres = 0.06;

        // The tip's way of a frame counts, too, up to this.
        private const double TrackedAheadMetres = 0.5;

        // What the search finds no longer is kept for so many updates: physics holds it elsewhere than it is drawn.
        private const int GraceUpdates = 4;

        // With too many colliders, those within this distance have priority.
        private const double TouchableWithinMetres = 0.003;

        private readonly Transform stylus;
        private readonly ColliderSearch search = new ColliderSearch();
        private readonly NearbyCollider[] near = new NearbyCollider[MaximumNearbyColliders];
        private bool hasTooMany;
        private bool hasWarned;
        private long update;
        private double scale = 1.0;

        // Of this update.
        private double secondsSinceStep;
        private int layers;
        private HapticSession session = null!;

        /// <param name="stylus">The stylus, whose own colliders the rules must not match.</param>
        public TipContacts(double tipRadiusMetres, Transform stylus)
        {
            this.stylus = stylus;
            Tracker = new ContactTracker(tipRadiusMetres) { Geometry = this };
            for (int index = 0; index < near.Length; ++index)
            {
                near[index] = new NearbyCollider();
            }
        }

        public ContactTracker Tracker { get; }

        /// <summary>The collider that <see cref="Update"/> found touched; null without a touch.</summary>
        public NearbyCollider? Touched { get; private set; }

        /// <summary>Metres of the world for a metre of the hand. The tracker and its readings are in metres of the
        /// hand, the reading's point excepted.</summary>
        public double Scale
        {
            get => scale;
            set
            {
                if (scale != value)
                {
                    scale = value;
                    Tracker.ForgetPath();
                }
            }
        }

        // In the world.
        private Double3 TipInWorld => scale * Tracker.TipMetres;

        /// <param name="sample">The tip in metres of the hand.</param>
        /// <param name="secondsSinceStep">Time since the last physics step, on the sample's clock; not a number where
        /// none runs.</param>
        public ContactReading Update(
            in TipSample sample, double secondsSinceStep, int layers, HapticSession session, Object context)
        {
            ++update;
            (this.secondsSinceStep, this.layers, this.session) = (secondsSinceStep, layers, session);
            if (Tracker.BeginFrame(sample))
            {
                search.BeginFrame(TipInWorld, Tracker.NowSeconds);
                Consider(context);
            }
            ContactReading reading = Tracker.EndFrame();
            reading.PointMetres = scale * reading.PointMetres;
            Touched = Find(reading.Surface);
            ReleaseDistant();
            return reading;
        }

        public void Forget()
        {
            Tracker.Forget();
            Touched = null;
            search.Forget();
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
            Double3 tip = scale * tipMetres;
            var question = new ProbeQuestion(
                tip, scale * (Tracker.TipRadiusMetres + ContactTransitions.SlideOffReachMetres),
                Tracker.HeldFaceOf(surface).Scaled(scale));
            bool isNear = ColliderProbe.TryClosest(
                place.Collider, ColliderProbe.PoseOf(place.Collider), question, out ProbeAnswer answer);
            found = RigScale.ToHand(answer.Point, scale);
            return isNear;
        }

        private void Consider(Object context)
        {
            using FrontFacesOnly fronts = FrontFacesOnly.Begin();
            SyncMovedMeshes();
            if (hasTooMany)
            {
                // Colliders that the tip may touch take precedence over those that are only tracked.
                ConsiderWithin(scale * (Tracker.ReachMetres + TouchableWithinMetres), true);
            }
            double trackedMetres = scale * (Tracker.ReachMetres + TrackedWithinMetres) +
                System.Math.Min(search.WayMetres, scale * TrackedAheadMetres);
            bool hasAll = ConsiderWithin(trackedMetres, false);
            ConsiderKept(trackedMetres);
            hasTooMany = !hasAll;
            if (Tracker.PassedWithinMetres > TrackedWithinMetres)
            {
                // With slow frames a hand comes from farther away, and passes what is then far behind it.
                ConsiderWithin(scale * (Tracker.ReachMetres + Tracker.PassedWithinMetres), false);
            }
            if (hasTooMany)
            {
                WarnTooManyColliders(context);
            }
        }

        /// <param name="takesPlaces">True to replace colliders that this update has not found near.</param>
        /// <returns>False where there was no room for some.</returns>
        private bool ConsiderWithin(double metres, bool takesPlaces)
        {
            bool hasAll = true;
            for (int number = 0; number < search.Searches; ++number)
            {
                // A scene may have been loaded with a physics world of its own, of which Physics knows nothing.
                search.Find(stylus.gameObject.scene.GetPhysicsScene(), TipInWorld, metres, layers, number);
                hasAll &= !search.IsFull;
                for (int index = 0; index < search.Count; ++index)
                {
                    hasAll &= ConsiderFound(search[index], metres, takesPlaces);
                }
                search.Clear();
            }
            return hasAll;
        }

        /// <returns>False where there was no room for the collider.</returns>
        private bool ConsiderFound(Collider collider, double metres, bool takesPlaces)
        {
            bool hasMaterial = Resolve(collider, out HapticSurface? surface, out MappedCollider? byRules);
            if (!hasMaterial || (search.IsWide && !IsDrawnWithin(collider, metres)))
            {
                return true;
            }
            NearbyCollider? place = PlaceFor(collider, surface, byRules, takesPlaces);
            if (place != null && place.LastUpdate != update)
            {
                place.LastFound = update;
                Consider(place, collider);
            }
            return place != null;
        }

        /// <summary>Colliders that the search no longer finds, although they are drawn near the tip.</summary>
        private void ConsiderKept(double metres)
        {
            foreach (NearbyCollider each in near)
            {
                Collider? collider = each.Collider;
                bool isKept = !(collider is null) && each.LastUpdate != update &&
                    (ReferenceEquals(each.Tracked, Tracker.Touched) || update - each.LastFound <= GraceUpdates) &&
                    IsTouchable(collider) && IsDrawnWithin(collider, metres);
                if (isKept && Resolve(collider!, out HapticSurface? surface, out MappedCollider? byRules) &&
                    each.Is(collider!, surface, byRules))
                {
                    Consider(each, collider!);
                }
            }
        }

        /// <summary>The material of a collider: its surface's, or that of rules. False without one.</summary>
        private bool Resolve(Collider collider, out HapticSurface? surface, out MappedCollider? byRules)
        {
            surface = SurfaceOf(collider);
            byRules = surface is object || IsOfStylus(collider) ? null : MappedColliders.Resolve(collider);
            return surface is object || byRules is object;
        }

        private bool IsDrawnWithin(Collider collider, double metres) =>
            ColliderProbe.DistanceBoundMetres(collider, TipInWorld) <= metres;

        /// <summary>True for a collider that the search could find: it may have been destroyed, switched off, or moved to
        /// another layer.</summary>
        private bool IsTouchable(Collider collider) =>
            collider != null && collider.enabled && !collider.isTrigger && collider.gameObject.activeInHierarchy &&
            (layers & (1 << collider.gameObject.layer)) != 0 &&
            collider.gameObject.scene.GetPhysicsScene().Equals(stylus.gameObject.scene.GetPhysicsScene());

        /// <summary>Rays hit a mesh where physics holds it; of one that a script moves, that is its pose of the last
        /// step.</summary>
        private void SyncMovedMeshes()
        {
            foreach (NearbyCollider each in near)
            {
                if (each.IsMovedMesh(scale))
                {
                    Physics.SyncTransforms();
                    return;
                }
            }
        }

        private void Consider(NearbyCollider place, Collider collider)
        {
            place.LastUpdate = update;
            RigidPose pose = ColliderProbe.PoseOf(collider);
            RigidPose inHand = RigScale.ToHand(pose, scale);
            place.Record(Tracker.NowSeconds, secondsSinceStep, inHand);
            Double3? from = Tracker.AdvancePath(place.Tracked, inHand);
            var question = new ProbeQuestion(
                TipInWorld, scale * Tracker.ReachMetresOf(place.Tracked), Tracker.HeldFaceOf(place.Tracked).Scaled(scale),
                from.HasValue ? scale * from.Value : (Double3?)null);
            if (ColliderProbe.TryClosest(collider, pose, question, out ProbeAnswer answer))
            {
                place.Place = new TouchedPlace(collider, answer.Point.PointMetres, answer.Hit);
                place.Resolve(session);
                place.Tracked.StiffnessNewtonsPerMetre = place.Felt.StiffnessNewtonsPerMetre;
                Tracker.Consider(new ContactCandidate(
                    place.Tracked, inHand, RigScale.ToHand(answer.Point, scale), answer.EntryShare));
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
                if (each.Is(collider, surface, byRules))
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
