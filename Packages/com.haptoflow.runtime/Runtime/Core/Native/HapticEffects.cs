#nullable enable
using System;

namespace HaptoFlow
{
    /// <summary>The effects of a surface. Effects that are not set cost a voice nothing.</summary>
    [Flags]
    public enum HapticEffects : uint
    {
        /// <summary>No value was set: the texture alone.</summary>
        Unspecified = 0,

        /// <summary>The vibration while the tip slides.</summary>
        Texture = 0x1,

        /// <summary>The impact of a landing: it grows with the approach speed and depends on the label.</summary>
        Impact = 0x2,

        /// <summary>The crossing of a rim, or to a label of another level.</summary>
        Edge = 0x4,

        /// <summary>No effect: the surface is touched but not felt.</summary>
        Nothing = 0x80000000,
    }

    /// <summary>The stages of a voice in the order of processing, except for the last three.</summary>
    public enum HapticEffect
    {
        /// <summary>The vibration while the tip slides.</summary>
        Texture = 0,

        /// <summary>The impact of a landing.</summary>
        Impact = 1,

        /// <summary>The crossing of a rim, or to a label of another level.</summary>
        Edge = 2,

        /// <summary>A delay of the whole signal, for studies and slow displays.</summary>
        Delay = 3,

        /// <summary>The inverse of the actuator's response.</summary>
        Compensation = 4,

        /// <summary>Lowers what has been strong for too long.</summary>
        ExposureGuard = 5,

        /// <summary>The spectral change by a material's tone or a surface's tilt; it follows the texture.</summary>
        Tone = 6,

        /// <summary>The sine of a study, instead of texture, impact and edge.</summary>
        Signal = 7,

        /// <summary>Louder and brighter for ears; it follows the compensation.</summary>
        Listen = 8,
    }
}
