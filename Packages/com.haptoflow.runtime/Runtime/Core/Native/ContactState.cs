#nullable enable
using System;
using System.Runtime.InteropServices;
using HaptoFlow.Native;
using HaptoFlow.Numerics;

namespace HaptoFlow
{
    /// <summary>State of a stylus tip at one moment: the input of the engine.</summary>
    /// <remarks>It is the haptoflow_contact_state of haptoflow.h, field by field and blittable, so that publishing
    /// converts nothing.</remarks>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct ContactState
    {
        internal uint StructSize;
        private uint touching;

        /// <summary>Number of touch-downs, so that a touch between two states is not lost. Where <see cref="Touching"/>
        /// returns with the same number above 0, the touch was only interrupted and has no second impact. 0 throughout
        /// for a caller that does not count: then each return has its impact.</summary>
        public uint TouchCounter;

        /// <summary>Labels of the touched surface with their weights.</summary>
        public LabelBlend Material;

        /// <summary>Velocity along the first of two axes fixed to the surface, relative to the surface, in m/s; limited
        /// to 20 m/s.</summary>
        public float FirstVelocityMps;

        /// <summary>Velocity along the second axis, in m/s; limited to 20 m/s.</summary>
        public float SecondVelocityMps;

        /// <summary>Normal force, 0 to 1000 N.</summary>
        public float ForceNewtons;

        /// <summary>Speed into the surface at the last landing, in m/s.</summary>
        public float ApproachSpeedMps;

        /// <summary>The effects of the surface; <see cref="HapticEffects.Unspecified"/> means the texture
        /// alone.</summary>
        public HapticEffects Effects;

        /// <summary>Number of rims that the tip has crossed or slid off. A change of label needs no count: the voice
        /// detects it.</summary>
        public uint EdgeCounter;

        /// <summary>Height of the last rim, 0 to 1 m.</summary>
        public float EdgeHeightMetres;

        /// <summary>Number of landings on another surface, or on another face of the same surface, during a touch. A
        /// touch-down is a landing that is not counted here.</summary>
        public uint LandingCounter;

        /// <summary>Feature scale: at 2, ribs are twice as far apart and all frequencies are those of half the speed,
        /// while the level is unchanged. 0 means 1; otherwise limited to 0.25 to 4.</summary>
        public float SpatialScale;

        /// <summary>Tilt of the spectrum about 150 Hz, -12 to 12 dB per octave, in addition to the material's own tone;
        /// positive is brighter, 0 is none.</summary>
        public float ToneDbPerOctave;

        private uint hasPlace;

        /// <summary>Names the surface: the same place of the same surface feels the same in every touch and every
        /// session, and surfaces with different numbers differ.</summary>
        public uint SurfaceSeed;

        /// <summary>The contact point in metres, in a frame that is fixed to the surface: while the surface moves and
        /// turns, the coordinates of a point on it stay the same. Read where <see cref="HasPlace"/> is true.</summary>
        public PlaceVector PlaceMetres;

        /// <summary>The first axis of the velocity in that frame, of length 1.</summary>
        public PlaceVector FirstAxis;

        /// <summary>The second axis of the velocity in that frame, of length 1.</summary>
        public PlaceVector SecondAxis;

        /// <summary>How much this object differs from other objects with the same labels, 0 to 1: at 0 all of them are
        /// the labels' mean, at 1 they differ as the recorded pieces of the labels did. <see cref="SurfaceSeed"/>, with
        /// or without a place, says which of the possible objects this one is. Without effect on learnt materials and
        /// with models that do not tell pieces apart. A single label changes in spectrum and level, a blend in
        /// spectrum.</summary>
        public float Variation;

        /// <summary>The relief under the tip, <see cref="HapticReliefMap.Number"/>; 0, or one that was disposed, for
        /// none.</summary>
        public uint Relief;

        /// <summary>Where the contact point lies in the relief's map: 0 to 1 along columns and along rows; a tiled map
        /// goes on beyond.</summary>
        public MapPlace ReliefPlace;

        /// <summary>The share of the full scale that the relief may reach, 0 to 1: what is small beside it is played as
        /// it is, and what is large approaches it, so that the texture keeps the rest.</summary>
        public float ReliefShare;

        /// <summary>True where <see cref="PlaceMetres"/> and the axes say where the tip is. Where they do not, the voice
        /// adds up the velocity from the touch-down on, and a place feels the same within one touch only.</summary>
        public bool HasPlace
        {
            readonly get => hasPlace != 0;
            set => hasPlace = value ? 1u : 0u;
        }

        /// <summary>True while the tip touches a surface.</summary>
        public bool Touching
        {
            readonly get => touching != 0;
            set => touching = value ? 1u : 0u;
        }
    }

    /// <summary>Labels with their weights: one material, or a blend of up to four. A part of the blittable
    /// <see cref="ContactState"/>.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public unsafe struct LabelBlend : IEquatable<LabelBlend>
    {
        /// <summary>Maximum number of labels in a blend.</summary>
        public const int Maximum = 4;

        private int count;
        private fixed int labels[Maximum];
        private fixed float weights[Maximum];

        /// <summary>One label alone.</summary>
        /// <param name="label">Index into the model's labels.</param>
        public static LabelBlend Of(int label)
        {
            var blend = default(LabelBlend);
            blend.Add(label, 1.0f);
            return blend;
        }

        /// <summary>Two labels.</summary>
        /// <param name="share">Weight of the second label: 0 for the first alone, 1 for the second alone.</param>
        public static LabelBlend Of(int first, int second, float share)
        {
            float weight = share >= 0.0f ? Math.Min(share, 1.0f) : 0.0f;
            var blend = default(LabelBlend);
            if (weight < 1.0f)
            {
                blend.Add(first, 1.0f - weight);
            }
            if (weight > 0.0f)
            {
                blend.Add(second, weight);
            }
            return blend;
        }

        /// <summary>Number of labels, 0 to <see cref="Maximum"/>. The engine replaces an empty blend by the model's
        /// first label.</summary>
        public readonly int Count => count;

        /// <param name="label">Index into the model's labels.</param>
        /// <param name="weight">0 to 1; weights need not sum to 1.</param>
        /// <exception cref="InvalidOperationException">The blend is full.</exception>
        public void Add(int label, float weight)
        {
            if (count == Maximum)
            {
                throw new InvalidOperationException("a blend has at most 4 labels");
            }
            labels[count] = label;
            weights[count] = weight;
            ++count;
        }

        /// <summary>Index of a label, for entries 0 to <see cref="Count"/> - 1.</summary>
        public int Label(int index) => labels[Place(index)];

        /// <summary>Weight of a label, for entries 0 to <see cref="Count"/> - 1.</summary>
        public float Weight(int index) => weights[Place(index)];

        /// <inheritdoc/>
        public bool Equals(LabelBlend other)
        {
            bool same = Count == other.Count;
            for (int index = 0; same && index < Count; ++index)
            {
                same = Label(index) == other.Label(index) && Weight(index).Equals(other.Weight(index));
            }
            return same;
        }

        /// <inheritdoc/>
        public override bool Equals(object? other) => other is LabelBlend blend && Equals(blend);

        /// <inheritdoc/>
        public override int GetHashCode() => HashCode.Combine(count, labels[0], labels[1], weights[0], weights[1]);

        private static int Place(int index) =>
            (uint)index < Maximum ? index : throw new ArgumentOutOfRangeException(nameof(index));
    }

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

        /// <summary>The heights of a map, which the tip follows.</summary>
        Relief = 0x200,

        /// <summary>No effect: the surface is touched but not felt.</summary>
        Nothing = 0x80000000,
    }

    /// <summary>The stages of a voice in the order of processing, except for the last five.</summary>
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

        /// <summary>The sine of a study, instead of texture, impact, edge and relief.</summary>
        Signal = 7,

        /// <summary>Louder and brighter for ears; it follows the compensation.</summary>
        Listen = 8,

        /// <summary>The heights of a map under the tip, added where impact and edge are.</summary>
        Relief = 9,

        /// <summary>A clip of <see cref="HapticVoice.PlayClip"/>, with or without contact, added where impact and edge
        /// are.</summary>
        Clip = 10,
    }

    /// <summary>A place in a map, as <see cref="ContactState"/> passes it to the library.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public readonly struct MapPlace
    {
        /// <summary>Along the columns; 1 is the map's whole length.</summary>
        public readonly float Column;

        /// <summary>Along the rows; 1 is the map's whole length.</summary>
        public readonly float Row;

        /// <summary>Shares of the map's lengths.</summary>
        public MapPlace(double column, double row) => (Column, Row) = ((float)column, (float)row);
    }

    /// <summary>A point or a direction in the frame of a surface, as <see cref="ContactState"/> passes it to the
    /// library.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public readonly struct PlaceVector
    {
        /// <summary>x coordinate in the surface's frame.</summary>
        public readonly float X;

        /// <summary>y coordinate in the surface's frame.</summary>
        public readonly float Y;

        /// <summary>z coordinate in the surface's frame.</summary>
        public readonly float Z;

        /// <summary>Coordinates in the surface's frame.</summary>
        public PlaceVector(float x, float y, float z) => (X, Y, Z) = (x, y, z);

        internal PlaceVector(Double3 vector) : this((float)vector.X, (float)vector.Y, (float)vector.Z)
        {
        }
    }
}
