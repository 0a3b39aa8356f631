#nullable enable
using UnityEngine;
using UnityEngine.Serialization;

namespace HaptoFlow
{
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
