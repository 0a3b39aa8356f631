#nullable enable
using System;
using UnityEngine;
using UnityEngine.Events;

namespace HaptoFlow
{
    /// <summary>The stylus's events for wiring in the Inspector, each with the surface. They are raised together with
    /// the C# events but without the contact's values. The surface is null for a collider whose material a <see
    /// cref="HapticMaterialMap"/> assigns. Main thread; raising them makes no garbage.</summary>
    [Serializable]
    public sealed class HapticStylusEvents
    {
        [SerializeField, Tooltip("Touch Began is raised when the tip touches a surface.")]
        private UnityEvent<HapticSurface> touchBegan = new UnityEvent<HapticSurface>();

        [SerializeField, Tooltip("Touch Moved is raised in every update while the touch lasts.")]
        private UnityEvent<HapticSurface> touchMoved = new UnityEvent<HapticSurface>();

        [SerializeField, Tooltip("Surface Changed is raised when the tip slides onto another surface without lifting " +
            "off.")]
        private UnityEvent<HapticSurface> surfaceChanged = new UnityEvent<HapticSurface>();

        [SerializeField, Tooltip("Touch Ended is raised when the touch ends, with the surface touched last.")]
        private UnityEvent<HapticSurface> touchEnded = new UnityEvent<HapticSurface>();

        /// <summary>The tip touched a surface.</summary>
        public UnityEvent<HapticSurface> TouchBegan => touchBegan;

        /// <summary>Raised once an update while the touch continues.</summary>
        public UnityEvent<HapticSurface> TouchMoved => touchMoved;

        /// <summary>The tip slid from one surface to this one without lifting.</summary>
        public UnityEvent<HapticSurface> SurfaceChanged => surfaceChanged;

        /// <summary>The touch ended; the surface is the last one, and may be destroyed.</summary>
        public UnityEvent<HapticSurface> TouchEnded => touchEnded;
    }
}
