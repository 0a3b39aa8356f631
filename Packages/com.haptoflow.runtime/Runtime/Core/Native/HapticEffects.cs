#nullable enable
using System;

namespace HaptoFlow
{
    /// <summary>What a surface asks for. A voice pays only for what is asked for.</summary>
    [Flags]
    public enum HapticEffects : uint
    {
        /// <summary>A state that says nothing asks for the texture alone.</summary>
        Unspecified = 0,

        /// <summary>What the network generates while the tip slides.</summary>
        Texture = 0x1,

        /// <summary>The blow of a landing: as loud as the approach was fast, and as the label answers it.</summary>
        Impact = 0x2,

        /// <summary>The crossing of a rim, or to a label of another level.</summary>
        Edge = 0x4,

        /// <summary>A surface that is touched and not felt.</summary>
        Nothing = 0x80000000,
    }

    /// <summary>The stages of a voice, in the order in which its signal goes through them, but for the last two.
    /// </summary>
    public enum HapticEffect
    {
        /// <summary>What the network generates while the tip slides.</summary>
        Texture = 0,

        /// <summary>The blow of a landing.</summary>
        Impact = 1,

        /// <summary>The crossing of a rim, or to a label of another level.</summary>
        Edge = 2,

        /// <summary>A delay of the whole signal, for studies and slow displays.</summary>
        Delay = 3,

        /// <summary>The inverse of the actuator's response.</summary>
        Compensation = 4,

        /// <summary>Brings down what has been strong for too long.</summary>
        ExposureGuard = 5,

        /// <summary>What a material, or a surface's tone, does to the texture's spectrum; right behind the texture.
        /// </summary>
        Tone = 6,

        /// <summary>A study's sine, which sounds instead of texture, impact and edge.</summary>
        Signal = 7,
    }
}
