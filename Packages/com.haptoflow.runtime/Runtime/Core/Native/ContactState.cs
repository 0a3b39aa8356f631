#nullable enable

namespace HaptoFlow
{
    /// <summary>What a stylus tip does now: what the engine generates from.</summary>
    public struct ContactState
    {
        /// <summary>The tip touches a surface.</summary>
        public bool Touching;

        /// <summary>One more at each touch-down: a touch that came and went since the last state is still
        /// felt.</summary>
        public uint TouchCounter;

        /// <summary>What the surface is made of.</summary>
        public LabelBlend Material;

        /// <summary>Along the first of two axes fixed to the surface, relative to its own motion; limited to 20 m/s.
        /// </summary>
        public float FirstVelocityMps;

        /// <summary>Along the second axis, limited to 20 m/s.</summary>
        public float SecondVelocityMps;

        /// <summary>Along the surface's normal, 0 to 1000 N.</summary>
        public float ForceNewtons;

        /// <summary>Into the surface, at the newest landing, in m/s.</summary>
        public float ApproachSpeedMps;

        /// <summary>What the surface asks for; the texture alone where nothing is said.</summary>
        public HapticEffects Effects;

        /// <summary>One more at each rim that the tip crosses or slides off. A change of label needs no count: the voice
        /// sees it.</summary>
        public uint EdgeCounter;

        /// <summary>How high the newest rim is, 0 to 1 m.</summary>
        public float EdgeHeightMetres;

        /// <summary>One more at each landing on another surface, or on another face of the same, while the tip goes on
        /// touching. A touch-down is a landing that needs no count.</summary>
        public uint LandingCounter;

        /// <summary>How many times as large the surface's features are as the material's: at 2, ribs are twice as far
        /// apart, and all frequencies are those of half the speed; the level stays. 0 for 1; else limited to 0.25 to 4.
        /// </summary>
        public float SpatialScale;

        /// <summary>Brighter above 0, darker below: a tilt of the spectrum about 150 Hz, -12 to 12 dB an octave; 0 for
        /// none. Comes on top of the material's own tone.</summary>
        public float ToneDbPerOctave;
    }
}
