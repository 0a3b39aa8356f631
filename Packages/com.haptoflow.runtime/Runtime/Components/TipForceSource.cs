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
    }
}
