#nullable enable
using UnityEngine;

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

        /// <summary>The labels at the touched place with their weights.</summary>
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
}
