#nullable enable
using System;
using HaptoFlow.Contact;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>What decides that a stylus touches.</summary>
    public enum TouchDecision
    {
        /// <summary>The tip sphere cuts into a tagged surface: for objects that are only virtual.</summary>
        Geometry,

        /// <summary>The force that the stylus measures on its tip, near a tagged surface: for a real object under the
        /// virtual one, where tracking and alignment are some millimetres off. While no force is measured, geometry
        /// decides.</summary>
        MeasuredForce,
    }

    /// <summary>When a measured force is a touch. Main thread.</summary>
    [Serializable]
    public sealed class ForceDecision
    {
        private const float LeastNewtons = 0.001f;
        private const float LeastMetres = 0.001f;

        // Colliders farther away are not asked for.
        private const float MostMetres = 0.04f;
        private const float MostOfPress = 0.9f;

        [SerializeField, Min(LeastNewtons), Tooltip("A touch begins at this force, in newtons.")]
        private float pressNewtons = (float)ForceTouchSettings.DefaultPressNewtons;

        [SerializeField, Min(0f), Tooltip("A touch ends at this force, in newtons: below the press force by more " +
            "than the sensor's noise.")]
        private float releaseNewtons = (float)ForceTouchSettings.DefaultReleaseNewtons;

        [SerializeField, Range(LeastMetres, MostMetres), Tooltip("How far from a tagged surface, on either side, the " +
            "pressing tip may be, in metres: more than tracking and alignment are off.")]
        private float nearMetres = (float)ForceTouchSettings.DefaultNearMetres;

        private ForceTouch? touch;

        /// <summary>A touch begins at this force, in newtons; 0.001 or more.</summary>
        public float PressNewtons
        {
            get => pressNewtons;
            set => Change(ref pressNewtons, Mathf.Max(LeastNewtons, value));
        }

        /// <summary>A touch ends at this force, in newtons; at most nine tenths of the press force count.</summary>
        public float ReleaseNewtons
        {
            get => releaseNewtons;
            set => Change(ref releaseNewtons, Mathf.Max(0f, value));
        }

        /// <summary>How far from a tagged surface the pressing tip may be, in metres, 0.001 to 0.04.</summary>
        public float NearMetres
        {
            get => nearMetres;
            set => Change(ref nearMetres, Mathf.Clamp(value, LeastMetres, MostMetres));
        }

        /// <summary>The decision with these thresholds; the same object until a threshold changes.</summary>
        internal ForceTouch Touch() => touch ??= NewTouch();

        /// <summary>A further decision with the same thresholds.</summary>
        internal ForceTouch NewTouch()
        {
            float press = Mathf.Max(LeastNewtons, pressNewtons);
            return new ForceTouch(new ForceTouchSettings
            {
                PressNewtons = press,
                ReleaseNewtons = Mathf.Clamp(releaseNewtons, 0f, MostOfPress * press),
                NearMetres = Mathf.Clamp(nearMetres, LeastMetres, MostMetres),
            });
        }

        /// <summary>The Inspector wrote into the fields.</summary>
        internal void Forget() => touch = null;

        private void Change(ref float field, float value)
        {
            field = value;
            touch = null;
        }
    }
}
