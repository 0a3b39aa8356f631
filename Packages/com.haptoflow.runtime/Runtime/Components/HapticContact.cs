#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>What a stylus touches, in world space: metres, m/s, newtons.</summary>
    public readonly struct HapticContact
    {
        private readonly FeltCollider? byRules;
        private readonly int part;

        internal HapticContact(NearbySurface touched, in FeltMaterial felt, in Contact.ContactReading reading)
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
            FirstVelocityMps = (float)reading.FirstVelocityMps;
            SecondVelocityMps = (float)reading.SecondVelocityMps;
            ForceNewtons = (float)reading.ForceNewtons;
            ApproachSpeedMps = (float)reading.ApproachSpeedMps;
            TouchCounter = reading.TouchCounter;
        }

        /// <summary>The surface that is touched; null where the collider has none and is felt by the rules of a
        /// <see cref="HapticMaterialMap"/>.</summary>
        public HapticSurface? Surface { get; }

        /// <summary>What the place is made of, to be read; of several materials the one with the most weight. Null
        /// where the place feels like nothing, or like nothing that the model knows.</summary>
        public MaterialDescription? Material { get; }

        /// <summary>The collider that is touched.</summary>
        public Collider Collider { get; }

        /// <summary>On the surface.</summary>
        public Vector3 Point { get; }

        /// <summary>Unit length, out of the surface.</summary>
        public Vector3 Normal { get; }

        /// <summary>How deep the tip sphere cuts into the surface, 0 or more.</summary>
        public float PenetrationMetres { get; }

        /// <summary>The first tangent axis, fixed to the surface: along its grain.</summary>
        public Vector3 FirstAxis { get; }

        /// <summary>The second tangent axis: first x second = normal.</summary>
        public Vector3 SecondAxis { get; }

        /// <summary>Of the tip relative to the surface, along the first axis.</summary>
        public float FirstVelocityMps { get; }

        /// <summary>Of the tip relative to the surface, along the second axis.</summary>
        public float SecondVelocityMps { get; }

        /// <summary>Of the tip relative to the surface, along it, in world space, m/s.</summary>
        public Vector3 TangentialVelocity => FirstAxis * FirstVelocityMps + SecondAxis * SecondVelocityMps;

        /// <summary>Along the normal: of the spring model, or measured.</summary>
        public float ForceNewtons { get; }

        /// <summary>Into the surface, at touch-down.</summary>
        public float ApproachSpeedMps { get; }

        /// <summary>Counts the stylus's touch-downs.</summary>
        public uint TouchCounter { get; }

        /// <summary>The labels of the place with their weights.</summary>
        internal LabelBlend Labels { get; }

        /// <summary>Why the place feels as it does, for people: which surface or which rule of which map says so. Makes
        /// garbage.</summary>
        public string Explain()
        {
            if (Surface is object)
            {
                return Surface != null ? $"Haptic Surface on \"{Surface.name}\"" : "a Haptic Surface that is gone";
            }
            return byRules?.Explain(part) ?? "";
        }

        /// <summary>On another surface; without surfaces, on another collider.</summary>
        internal bool IsElsewhere(in HapticContact before) =>
            !ReferenceEquals(Surface, before.Surface) ||
            (Surface is null && !ReferenceEquals(Collider, before.Collider));
    }

    /// <summary>Called on the main thread.</summary>
    public delegate void HapticContactHandler(HapticStylus stylus, in HapticContact contact);
}
