#nullable enable
using System;
using UnityEngine;
using UnityEngine.Events;

namespace HaptoFlow
{
    /// <summary>A touch of a stylus, in world space: metres, m/s, newtons. What a handler gets: Unity's types, and
    /// surface and material, instead of the model's reading. Speeds and depth are in metres of the hand, which differ
    /// from the world's under a scaled rig.</summary>
    public readonly struct HapticContact
    {
        private readonly MappedCollider? byRules;
        private readonly int part;

        internal HapticContact(NearbyCollider touched, in ResolvedMaterial felt, in Contact.ContactReading reading)
        {
            Surface = touched.Surface;
            byRules = touched.ByRules;
            part = felt.Part;
            Material = felt.Heaviest;
            Labels = felt.Labels;
            Collider = touched.Collider!;
            Point = reading.PointMetres.ToVector();
            Normal = reading.Normal.ToVector();
            PenetrationMetres = (float)reading.PenetrationMetres;
            FirstAxis = reading.FirstAxis.ToVector();
            SecondAxis = reading.SecondAxis.ToVector();
            FirstVelocityMps = reading.State.FirstVelocityMps;
            SecondVelocityMps = reading.State.SecondVelocityMps;
            ForceNewtons = reading.State.ForceNewtons;
            ApproachSpeedMps = reading.State.ApproachSpeedMps;
            TouchCounter = reading.State.TouchCounter;
        }

        /// <summary>The touched surface; null where the collider has none and a <see cref="HapticMaterialMap"/> assigns
        /// its material.</summary>
        public HapticSurface? Surface { get; }

        /// <summary>The material at the touched place, for reading; of several materials the one with the largest
        /// weight. Null where the place has no material that the model knows.</summary>
        public MaterialDescription? Material { get; }

        /// <summary>The touched collider.</summary>
        public Collider Collider { get; }

        /// <summary>The contact point, on the surface.</summary>
        public Vector3 Point { get; }

        /// <summary>Unit normal, pointing out of the surface.</summary>
        public Vector3 Normal { get; }

        /// <summary>Penetration depth of the tip sphere, 0 or more.</summary>
        public float PenetrationMetres { get; }

        /// <summary>The first tangent axis, fixed to the surface along its grain.</summary>
        public Vector3 FirstAxis { get; }

        /// <summary>The second tangent axis; first x second = normal.</summary>
        public Vector3 SecondAxis { get; }

        /// <summary>Velocity of the tip relative to the surface along the first axis.</summary>
        public float FirstVelocityMps { get; }

        /// <summary>Velocity of the tip relative to the surface along the second axis.</summary>
        public float SecondVelocityMps { get; }

        /// <summary>Tangential velocity of the tip relative to the surface, in world space, m/s.</summary>
        public Vector3 TangentialVelocity => FirstAxis * FirstVelocityMps + SecondAxis * SecondVelocityMps;

        /// <summary>Normal force: from the spring model, or measured.</summary>
        public float ForceNewtons { get; }

        /// <summary>Speed into the surface at touch-down.</summary>
        public float ApproachSpeedMps { get; }

        /// <summary>Number of touch-downs of the stylus so far.</summary>
        public uint TouchCounter { get; }

        internal LabelBlend Labels { get; }

        /// <summary>Names the surface, or the rule and its map, that gives the place its material. For people; makes
        /// garbage.</summary>
        public string Explain()
        {
            if (Surface is object)
            {
                return Surface != null ? $"Haptic Surface on \"{Surface.name}\"" : "a Haptic Surface that is gone";
            }
            return byRules?.Explain(part) ?? "";
        }

        /// <summary>True where the touch moved to another surface; without surfaces, to another collider.</summary>
        internal bool IsElsewhere(in HapticContact before) =>
            !ReferenceEquals(Surface, before.Surface) ||
            (Surface is null && !ReferenceEquals(Collider, before.Collider));
    }

    /// <summary>Handles an event of a stylus's touch. Called on the main thread.</summary>
    public delegate void HapticContactHandler(HapticStylus stylus, in HapticContact contact);

    /// <summary>The stylus's events for wiring in the Inspector, each with the surface. They are raised together with
    /// the C# events but without the contact's values. The surface is null for a collider whose material a <see
    /// cref="HapticMaterialMap"/> assigns. Main thread; raising them makes no garbage.</summary>
    [Serializable]
    public sealed class HapticStylusEvents
    {
        [SerializeField, Tooltip("Touch Began is raised when the tip touches a surface.")]
        private UnityEvent<HapticSurface> touchBegan = new UnityEvent<HapticSurface>();

        [SerializeField, Tooltip("Touch Moved is raised in every update while the touch lasts.")]
        private UnityEvent<HapticSurface> touchMoved = new UnityEvent<HapticSurface>();

        [SerializeField, Tooltip("Surface Changed is raised when the tip slides onto another surface without lifting " +
            "off.")]
        private UnityEvent<HapticSurface> surfaceChanged = new UnityEvent<HapticSurface>();

        [SerializeField, Tooltip("Touch Ended is raised when the touch ends, with the surface touched last.")]
        private UnityEvent<HapticSurface> touchEnded = new UnityEvent<HapticSurface>();

        /// <summary>The tip touched a surface.</summary>
        public UnityEvent<HapticSurface> TouchBegan => touchBegan;

        /// <summary>Raised once an update while the touch continues.</summary>
        public UnityEvent<HapticSurface> TouchMoved => touchMoved;

        /// <summary>The tip slid from one surface to this one without lifting.</summary>
        public UnityEvent<HapticSurface> SurfaceChanged => surfaceChanged;

        /// <summary>The touch ended; the surface is the last one, and may be destroyed.</summary>
        public UnityEvent<HapticSurface> TouchEnded => touchEnded;
    }
}
