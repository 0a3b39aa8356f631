#nullable enable
using System;
using UnityEngine;
using UnityEngine.Events;

namespace HaptoFlow
{
    /// <summary>The stylus's events for wiring in the Inspector, each with the surface: what the C# events tell,
    /// without the contact's numbers. The surface is null for a collider that is felt by the rules of a
    /// <see cref="HapticMaterialMap"/>. Main thread; invoking them makes no garbage.</summary>
    [Serializable]
    public sealed class HapticStylusEvents
    {
        [SerializeField, Tooltip("The tip touched a surface.")]
        private UnityEvent<HapticSurface> touchBegan = new UnityEvent<HapticSurface>();

        [SerializeField, Tooltip("The touch goes on: once an update.")]
        private UnityEvent<HapticSurface> touchMoved = new UnityEvent<HapticSurface>();

        [SerializeField, Tooltip("The tip slid from one surface to this one without lifting.")]
        private UnityEvent<HapticSurface> surfaceChanged = new UnityEvent<HapticSurface>();

        [SerializeField, Tooltip("The touch ended; the surface is the last one.")]
        private UnityEvent<HapticSurface> touchEnded = new UnityEvent<HapticSurface>();

        /// <summary>The tip touched a surface.</summary>
        public UnityEvent<HapticSurface> TouchBegan => touchBegan;

        /// <summary>The touch goes on; once an update.</summary>
        public UnityEvent<HapticSurface> TouchMoved => touchMoved;

        /// <summary>The tip slid from one surface to this one without lifting.</summary>
        public UnityEvent<HapticSurface> SurfaceChanged => surfaceChanged;

        /// <summary>The touch ended; the surface is the last one, and may be destroyed.</summary>
        public UnityEvent<HapticSurface> TouchEnded => touchEnded;
    }
}
