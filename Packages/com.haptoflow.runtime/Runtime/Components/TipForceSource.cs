#nullable enable
using System;
using HaptoFlow.Contact;
using UnityEngine;
using UnityEngine.Serialization;

namespace HaptoFlow
{
    /// <summary>A source of a stylus's measured tip force. Derive from this class for a device, add the component to a
    /// GameObject and assign it to the stylus.</summary>
    public abstract class TipForceSource : MonoBehaviour
    {
        /// <summary>The present force on the tip. Called on the main thread, once a frame; must make no
        /// garbage.</summary>
        /// <param name="forceNewtons">0 or more.</param>
        /// <returns>False where the device reports none: the spring model then supplies the force.</returns>
        public abstract bool TryRead(out float forceNewtons);

        /// <summary>The measured force, 0 for a tip in the air: called instead of <see cref="TryRead"/> where the force
        /// decides what touches (<see cref="TouchDecision.MeasuredForce"/>). Main thread, once a frame; must make no
        /// garbage.</summary>
        /// <param name="forceNewtons">0 or more.</param>
        /// <returns>False where the device measures nothing: geometry then decides.</returns>
        public virtual bool TryMeasure(out float forceNewtons) => TryRead(out forceNewtons);

        /// <summary>The hand that holds the device that measures, for a stylus whose own hand is not set; <see
        /// cref="HapticHand.None"/> where no hand does, or at present none is known to. Main thread; must make no
        /// garbage.</summary>
        public virtual HapticHand HeldIn => HapticHand.None;
    }

    /// <summary>What decides whether a stylus touches.</summary>
    public enum TouchDecision
    {
        /// <summary>The tip sphere cuts into a tagged surface. For objects that exist only virtually.</summary>
        Geometry,

        /// <summary>The force that the stylus measures on its tip, near a tagged surface. For a real object below the
        /// virtual one, where tracking and alignment are wrong by some millimetres. While no force is measured,
        /// geometry decides.</summary>
        MeasuredForce,
    }

    /// <summary>Thresholds that turn a measured force into touch-down and lift-off. Main thread.</summary>
    [Serializable]
    public sealed class ForceDecision
    {
        private const float MinimumNewtons = 0.001f;
        private const float MinimumMetres = 0.001f;

        // Physics queries do not look for colliders farther away than this.
        private const float MaximumMetres = 0.04f;
        private const float MaximumReleaseShare = 0.9f;

        [SerializeField, Min(MinimumNewtons), Tooltip("A touch begins at this force, in newtons.")]
        private float pressNewtons = (float)ForceTouch.DefaultPressNewtons;

        [SerializeField, Min(0f), Tooltip("A touch ends at this force, in newtons. It has to be below the press " +
            "force by more than the sensor's noise.")]
        private float releaseNewtons = (float)ForceTouch.DefaultReleaseNewtons;

        [SerializeField, Range(MinimumMetres, MaximumMetres), Tooltip("A pressing tip touches a surface within this " +
            "distance on either side, in metres. The distance has to exceed the errors of tracking and alignment.")]
        private float nearMetres = (float)ForceTouch.DefaultNearMetres;

        private ForceTouch? detector;

        /// <summary>A touch begins at this force, in newtons; 0.001 or more.</summary>
        public float PressNewtons
        {
            get => pressNewtons;
            set => Change(ref pressNewtons, Mathf.Max(MinimumNewtons, value));
        }

        /// <summary>A touch ends at this force, in newtons. Values above nine tenths of the press force are treated as
        /// nine tenths of it.</summary>
        public float ReleaseNewtons { get => releaseNewtons; set => Change(ref releaseNewtons, Mathf.Max(0f, value)); }

        /// <summary>Largest distance between the pressing tip and a tagged surface, in metres, 0.001 to 0.04.</summary>
        public float NearMetres
        {
            get => nearMetres;
            set => Change(ref nearMetres, Mathf.Clamp(value, MinimumMetres, MaximumMetres));
        }

        /// <summary>The detector with these thresholds; the same object until a threshold changes.</summary>
        internal ForceTouch Detector() => detector ??= NewDetector();

        internal ForceTouch NewDetector()
        {
            float press = Mathf.Max(MinimumNewtons, pressNewtons);
            return new ForceTouch
            {
                PressNewtons = press,
                ReleaseNewtons = Mathf.Clamp(releaseNewtons, 0f, MaximumReleaseShare * press),
                NearMetres = Mathf.Clamp(nearMetres, MinimumMetres, MaximumMetres),
            };
        }

        internal void ResetDetector() => detector = null;

        private void Change(ref float field, float value)
        {
            field = value;
            detector = null;
        }
    }

    /// <summary>A device that reports the pressure on its tip from 0 to 1, as pens do.</summary>
    /// <remarks>In the air a pen reports 0, even with its tip inside a virtual object; the spring model then supplies
    /// the force, so that the object can still be felt.</remarks>
    public abstract class PressureTipForce : TipForceSource
    {
        [SerializeField, Min(0f), Tooltip("The force at which the device reports 1, in newtons: from its data " +
            "sheet, or measured with a scale.")]
        private float newtonsAtFullPressure = 1f;

        [SerializeField, FormerlySerializedAs("leastPressure"), Range(0f, 1f)]
        [Tooltip("Pressures up to this value count as a tip in the air.")]
        private float minimumPressure = 0.01f;

        /// <summary>Force at which the device reports 1, in newtons.</summary>
        public float NewtonsAtFullPressure
        {
            get => newtonsAtFullPressure;
            set => newtonsAtFullPressure = Mathf.Max(0f, value);
        }

        /// <summary>Pressures up to this value, 0 to 1, count as a tip in the air.</summary>
        public float MinimumPressure { get => minimumPressure; set => minimumPressure = Mathf.Clamp01(value); }

        /// <inheritdoc/>
        public sealed override bool TryRead(out float forceNewtons)
        {
            bool pressed = TryReadPressure(out float pressure) && pressure > minimumPressure;
            forceNewtons = pressed ? Mathf.Clamp01(pressure) * newtonsAtFullPressure : 0f;
            return pressed;
        }

        /// <inheritdoc/>
        public sealed override bool TryMeasure(out float forceNewtons)
        {
            bool hasPressure = TryReadPressure(out float pressure);
            bool pressed = hasPressure && pressure > minimumPressure;
            forceNewtons = pressed ? Mathf.Clamp01(pressure) * newtonsAtFullPressure : 0f;
            return hasPressure && !float.IsNaN(pressure);
        }

        /// <summary>The present pressure, 0 to 1; false where the device reports none. Main thread; must make no
        /// garbage.</summary>
        protected abstract bool TryReadPressure(out float pressure);
    }
}
