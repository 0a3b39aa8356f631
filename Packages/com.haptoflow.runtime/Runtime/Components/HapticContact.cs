#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>What a stylus touches, in world space: metres, m/s, newtons.</summary>
    public readonly struct HapticContact
    {
        internal HapticContact(HapticSurface surface, Collider collider, in Contact.ContactReading reading)
        {
            Surface = surface;
            Collider = collider;
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

        /// <summary>What is touched.</summary>
        public HapticSurface Surface { get; }

        /// <summary>Which of its colliders is touched.</summary>
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
    }

    /// <summary>Called on the main thread.</summary>
    public delegate void HapticContactHandler(HapticStylus stylus, in HapticContact contact);
}
