#nullable enable
using System.Runtime.InteropServices;
using HaptoFlow.Native;

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
}
