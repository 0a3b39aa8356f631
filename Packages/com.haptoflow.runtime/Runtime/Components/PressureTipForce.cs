#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A device that reports the pressure on its tip from 0 to 1, as pens do.</summary>
    /// <remarks>A pen in the air reports 0, also where its tip is inside a virtual object. There the spring model
    /// counts:
    /// what is felt in the air must not fall silent.</remarks>
    public abstract class PressureTipForce : TipForceSource
    {
        [SerializeField, Min(0f), Tooltip("What the device reports as 1, in newtons: from its data sheet, or weighed.")]
        private float newtonsAtFullPressure = 1f;

        [SerializeField, Range(0f, 1f), Tooltip("Pressures up to this are a tip in the air.")]
        private float leastPressure = 0.01f;

        /// <summary>What the device reports as 1, in newtons.</summary>
        public float NewtonsAtFullPressure
        {
            get => newtonsAtFullPressure;
            set => newtonsAtFullPressure = Mathf.Max(0f, value);
        }

        /// <summary>0 to 1; pressures up to this are a tip in the air.</summary>
        public float LeastPressure
        {
            get => leastPressure;
            set => leastPressure = Mathf.Clamp01(value);
        }

        /// <inheritdoc/>
        public sealed override bool TryRead(out float forceNewtons)
        {
            bool pressed = TryReadPressure(out float pressure) && pressure > leastPressure;
            forceNewtons = pressed ? Mathf.Clamp01(pressure) * newtonsAtFullPressure : 0f;
            return pressed;
        }

        /// <inheritdoc/>
        public sealed override bool TryMeasure(out float forceNewtons)
        {
            bool hasNews = TryReadPressure(out float pressure);
            bool pressed = hasNews && pressure > leastPressure;
            forceNewtons = pressed ? Mathf.Clamp01(pressure) * newtonsAtFullPressure : 0f;
            return hasNews && !float.IsNaN(pressure);
        }

        /// <summary>The pressure now, 0 to 1; false where the device has no news. Main thread; must make no garbage.
        /// </summary>
        protected abstract bool TryReadPressure(out float pressure);
    }
}
