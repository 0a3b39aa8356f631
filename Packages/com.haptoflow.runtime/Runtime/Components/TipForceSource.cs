#nullable enable
using UnityEngine;

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
}
