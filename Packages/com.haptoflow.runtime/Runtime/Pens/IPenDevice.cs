#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A pen in one hand that a vendor's SDK knows and the Input System does not. All calls on the main thread
    /// and without garbage.</summary>
    public interface IPenDevice
    {
        /// <summary>Reads the pen. Called once a frame; must not log each time.</summary>
        /// <param name="position">Position of the tip relative to the tracking space, in metres.</param>
        /// <param name="rotation">Orientation relative to the tracking space; forward is where the tip points.</param>
        /// <param name="pressure">Pressure on the tip, 0 to 1; NaN where the pen measures none at present.</param>
        /// <returns>False while the pen is not in this hand.</returns>
        bool TryRead(out Vector3 position, out Quaternion rotation, out float pressure);
    }
}
