#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Where a stylus's own tip force comes from: derive from this for a device, put it on a GameObject and
    /// name it in the stylus.</summary>
    public abstract class TipForceSource : MonoBehaviour
    {
        /// <summary>The force on the tip now. Called on the main thread, once a frame; must make no garbage.</summary>
        /// <param name="forceNewtons">0 or more.</param>
        /// <returns>False where the device has no news: then the spring model counts.</returns>
        public abstract bool TryRead(out float forceNewtons);

        /// <summary>The force as it is measured, 0 for a tip in the air: asked in place of <see cref="TryRead"/> where
        /// the force decides what touches (<see cref="TouchDecision.MeasuredForce"/>). Main thread, once a frame; must
        /// make no garbage.</summary>
        /// <param name="forceNewtons">0 or more.</param>
        /// <returns>False where the device measures nothing now: then geometry decides.</returns>
        public virtual bool TryMeasure(out float forceNewtons) => TryRead(out forceNewtons);
    }
}
