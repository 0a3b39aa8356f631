#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Runtime.CompilerServices;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Draws the heights of a relief as a line above the surface: where a tip has just been, and without play
    /// mode through the middle of a selected surface, along its grain.</summary>
    internal static class ReliefGizmos
    {
        // A higher line would leave its place on the surface.
        private const double HighestMetres = 0.01;

        private static readonly double[] Factors = { 100.0, 50.0, 20.0, 10.0, 5.0, 2.0 };
        private static readonly Color LineColour = new Color(0.9f, 0.55f, 1f);
        private static readonly Color GroundColour = new Color(0.9f, 0.55f, 1f, 0.35f);

        // By stylus; what is destroyed is forgotten, and so is all at a reload of the domain.
        private static readonly ConditionalWeakTable<HapticStylus, ReliefTrail> Trails =
            new ConditionalWeakTable<HapticStylus, ReliefTrail>();

        private static readonly List<ReliefPoint> Points = new List<ReliefPoint>();
        private static readonly List<Collider> Below = new List<Collider>();

        [DrawGizmo(GizmoType.Selected)]
        internal static void Draw(HapticSurface surface, GizmoType type)
        {
            if (!Application.isPlaying && surface.isActiveAndEnabled && surface.Relief != null &&
                surface.Relief.Heights is { } heights && ColliderOf(surface) is { } collider)
            {
                ReliefSection.Read(surface, collider, Points);
                Draw(surface.Relief, heights, Points);
            }
        }

        /// <summary>Draws where the tip of a stylus has been, if the stylus or what it touches is selected.</summary>
        internal static void Draw(HapticStylus stylus, bool isSelected)
        {
            if (!stylus.isActiveAndEnabled || !stylus.TryGetRelief(out HapticRelief relief, out MapPlace place) ||
                !(relief.Heights is { } heights) || stylus.Contact.Collider == null ||
                !(isSelected || IsSelected(stylus.Contact)))
            {
                Trails.Remove(stylus);
                return;
            }
            ReliefTrail trail = Trails.GetOrCreateValue(stylus);
            trail.Add(stylus.Contact, relief, place);
            trail.Read(Points);
            Draw(relief, heights, Points);
        }

        /// <summary>How many times as high as it is a relief is drawn.</summary>
        internal static double FactorOf(double depthMetres)
        {
            double found = Array.Find(Factors, factor => factor * depthMetres <= 1.0001 * HighestMetres);
            return found > 0.0 ? found : 1.0;
        }

        private static bool IsSelected(in HapticContact contact)
        {
            GameObject touched = contact.Collider.gameObject;
            GameObject? owner = contact.Surface != null ? contact.Surface.gameObject : null;
            return Array.Exists(Selection.gameObjects, each => each == touched || each == owner);
        }

        /// <summary>The surface's first collider that has a place in the map, nearest to it in the hierarchy.</summary>
        private static Collider? ColliderOf(HapticSurface surface)
        {
            surface.GetComponentsInChildren(false, Below);
            Collider? found = Below.Find(collider => collider.enabled && SceneColliders.CanBeFelt(collider) &&
                ReliefRules.WhyNotFelt(collider) == null && SceneColliders.SurfaceOf(collider) == surface);
            Below.Clear();
            return found;
        }

        private static void Draw(HapticRelief relief, ReliefHeights heights, List<ReliefPoint> points)
        {
            double factor = FactorOf(heights.DepthMetres);
            Vector3? before = null;
            Vector3 ground = default;
            bool lacksCaption = true;
            foreach (ReliefPoint point in points)
            {
                double metres = point.IsOnMap ? heights.MetresAt(point.Place) : double.NaN;
                if (double.IsNaN(metres))
                {
                    before = null;
                    continue;
                }
                Vector3 lifted = point.Position + (float)(factor * metres) * point.Normal;
                if (before.HasValue)
                {
                    Gizmos.color = GroundColour;
                    Gizmos.DrawLine(ground, point.Position);
                    Gizmos.color = LineColour;
                    Gizmos.DrawLine(before.Value, lifted);
                }
                else if (lacksCaption)
                {
                    lacksCaption = false;
                    Handles.Label(lifted, string.Format(
                        CultureInfo.InvariantCulture, "{0}, heights x {1:0}", relief.name, factor));
                }
                (before, ground) = (lifted, point.Position);
            }
        }
    }

    /// <summary>A place on a surface, in the world, and where it lies in a map.</summary>
    internal readonly struct ReliefPoint
    {
        public readonly Vector3 Position;
        public readonly Vector3 Normal;
        public readonly MapPlace Place;
        public readonly bool IsOnMap;

        public ReliefPoint(Vector3 position, Vector3 normal, in MapPlace place, bool isOnMap = true) =>
            (Position, Normal, Place, IsOnMap) = (position, normal, place, isOnMap);
    }

    /// <summary>Places along the grain of a surface, through the middle of its widest side.</summary>
    internal static class ReliefSection
    {
        private const int Places = 192;

        // A longer section would have too few places for a texel.
        private const double MostMaps = 2.0;

        private const double ClearanceMetres = 0.01;

        /// <param name="points">Replaced by the places; those beside the surface are on no map.</param>
        public static void Read(HapticSurface surface, Collider collider, List<ReliefPoint> points)
        {
            points.Clear();
            if (!ColliderProbe.TryGetBounds(collider, out Bounds bounds))
            {
                return;
            }
            bool isTerrain = collider is TerrainCollider;
            // Unity scales no terrain.
            Double3 scale = isTerrain ? new Double3(1.0, 1.0, 1.0) : collider.transform.lossyScale.ToDouble();
            Double3 half = 0.5 * Double3.Scale(bounds.size.ToDouble(), scale).Absolute;
            Double3 middle = Double3.Scale(bounds.center.ToDouble(), scale);
            RigidPose pose = ColliderProbe.PoseOf(collider);
            Double3 outward = isTerrain ? Double3.Up : ThinAxis(half);
            // Of the two sides first the one that is seen from above.
            outward = pose.DirectionToWorld(outward).Y < 0.0 ? -outward : outward;
            using FrontFacesOnly fronts = FrontFacesOnly.Begin();
            if (!TryRead(surface, collider, pose, middle, half, outward, points))
            {
                points.Clear();
                TryRead(surface, collider, pose, middle, half, -outward, points);
            }
        }

        private static Double3 ThinAxis(Double3 half) =>
            half.Y <= half.X && half.Y <= half.Z ? Double3.Up : half.X <= half.Z ? Double3.Right : Double3.Forward;

        /// <returns>False where no place is on the map.</returns>
        private static bool TryRead(HapticSurface surface, Collider collider, in RigidPose pose, Double3 middle,
            Double3 half, Double3 outward, List<ReliefPoint> points)
        {
            HapticRelief relief = surface.Relief!;
            var frame = new TangentFrame(NearbyCollider.GrainOf(collider, surface));
            Double3 along = frame.FirstAxisOfNewTouch(outward);
            double above = Double3.Dot(outward.Absolute, half) + ClearanceMetres;
            double reach = Math.Min(Double3.Dot(along.Absolute, half),
                0.5 * MostMaps * Math.Max(relief.SizeMetres.x, relief.SizeMetres.y));
            bool isAny = false;
            for (int index = 0; index < Places; ++index)
            {
                // Not on the rims themselves, which a ray may miss.
                double share = 2.0 * (index + 0.5) / Places - 1.0;
                Double3 start = middle + share * reach * along + above * outward;
                ReliefPoint point = At(relief, collider, frame, pose, start, outward, above);
                isAny |= point.IsOnMap;
                points.Add(point);
            }
            return isAny;
        }

        private static ReliefPoint At(HapticRelief relief, Collider collider, TangentFrame frame, in RigidPose pose,
            Double3 start, Double3 outward, double above)
        {
            Vector3 normal = pose.DirectionToWorld(outward).ToVector();
            Double3 place = start - ClearanceMetres * outward;
            RaycastHit? found = null;
            if (!(collider is BoxCollider))
            {
                var ray = new Ray(pose.PointToWorld(start).ToVector(), -normal);
                if (!collider.Raycast(ray, out RaycastHit hit, (float)(2.0 * above)))
                {
                    return new ReliefPoint(Vector3.zero, normal, default, false);
                }
                (found, normal, place) = (hit, hit.normal, pose.PointToLocal(hit.point.ToDouble()));
            }
            bool isOnMap = ReliefPlace.TryFind(relief, collider, frame, new TouchedPlace(collider, place, found),
                pose.DirectionToLocal(normal.ToDouble()), out MapPlace inMap);
            return new ReliefPoint(pose.PointToWorld(place).ToVector(), normal, inMap, isOnMap);
        }
    }

    /// <summary>The last few centimetres of a tip's way over a relief, fixed to what it touches.</summary>
    internal sealed class ReliefTrail
    {
        private const double LengthMetres = 0.03;
        private const double LongestSeconds = 1.0;

        // Between two frames the tip goes straight, as for the engine.
        private const int StepsPerFrame = 16;

        private readonly List<Kept> kept = new List<Kept>();
        private Collider? touched;
        private HapticRelief? relief;
        private uint touch;
        private int frame = -1;

        /// <summary>Adds a touch, once for each frame.</summary>
        public void Add(in HapticContact contact, HapticRelief felt, in MapPlace place)
        {
            if (!ReferenceEquals(touched, contact.Collider) || !ReferenceEquals(relief, felt) ||
                touch != contact.TouchCounter)
            {
                kept.Clear();
                (touched, relief, touch) = (contact.Collider, felt, contact.TouchCounter);
            }
            else if (frame == Time.frameCount)
            {
                return;
            }
            frame = Time.frameCount;
            RigidPose pose = ColliderProbe.PoseOf(contact.Collider);
            kept.Add(new Kept(Time.unscaledTimeAsDouble, pose.PointToLocal(contact.Point.ToDouble()),
                pose.DirectionToLocal(contact.Normal.ToDouble()), place));
            Shorten();
        }

        /// <param name="points">Replaced by the places of the way, the oldest first.</param>
        public void Read(List<ReliefPoint> points)
        {
            points.Clear();
            RigidPose pose = ColliderProbe.PoseOf(touched!);
            for (int index = 0; index < kept.Count; ++index)
            {
                Kept from = kept[index];
                Kept to = kept[Math.Min(index + 1, kept.Count - 1)];
                int steps = index + 1 < kept.Count ? StepsPerFrame : 1;
                for (int step = 0; step < steps; ++step)
                {
                    points.Add(Between(pose, from, to, step / (double)steps));
                }
            }
        }

        private static ReliefPoint Between(in RigidPose pose, in Kept from, in Kept to, double share) =>
            new ReliefPoint(
                pose.PointToWorld(from.Place + share * (to.Place - from.Place)).ToVector(),
                pose.DirectionToWorld(from.Normal).ToVector(),
                new MapPlace(from.InMap.Column + share * (to.InMap.Column - from.InMap.Column),
                    from.InMap.Row + share * (to.InMap.Row - from.InMap.Row)));

        /// <summary>Forgets what is too far back or too long ago.</summary>
        private void Shorten()
        {
            double way = 0.0;
            int first = kept.Count - 1;
            while (first > 0 && way < LengthMetres &&
                kept[kept.Count - 1].Seconds - kept[first - 1].Seconds <= LongestSeconds)
            {
                way += Double3.Distance(kept[first].Place, kept[first - 1].Place);
                --first;
            }
            kept.RemoveRange(0, first);
        }

        private readonly struct Kept
        {
            public readonly double Seconds;
            public readonly Double3 Place;
            public readonly Double3 Normal;
            public readonly MapPlace InMap;

            public Kept(double seconds, Double3 place, Double3 normal, in MapPlace inMap) =>
                (Seconds, Place, Normal, InMap) = (seconds, place, normal, inMap);
        }
    }
}
