#nullable enable

namespace HaptoFlow.Preview
{
    /// <summary>Position, velocity and force of the tip at one time, in double precision for the charts. A path gives
    /// what belongs to its point, before it wraps at the edges of the patch; <see cref="Stroke"/> adds the rest.
    /// Positions are relative to the patch's lower left corner; x is the surface's first axis, to the right, y the
    /// second, upwards.</summary>
    internal struct StrokeState
    {
        public double XMetres;
        public double YMetres;

        /// <summary>The position before it wrapped: at the edge of the patch the picture jumps, not the sound. Set by
        /// the stroke.</summary>
        public double WayXMetres;
        public double WayYMetres;
        public double VelocityXMps;
        public double VelocityYMps;
        public double ForceNewtons;
        public bool Touching;

        /// <summary>Normal speed at the touch-down.</summary>
        public double LandingSpeedMps;

        /// <summary>Increases by one at each rim.</summary>
        public uint EdgeCounter;

        /// <summary>Time since the start of the stroke. Set by the stroke.</summary>
        public double TimeSeconds;

        /// <summary>Increases by one at each touch-down. Set by the stroke.</summary>
        public uint TouchCounter;

        /// <summary>True if the previous state belongs to the same touch and the path did not wrap in between. Set by
        /// the stroke.</summary>
        public bool Continues;

        public readonly double SpeedMps => System.Math.Sqrt(VelocityXMps * VelocityXMps + VelocityYMps * VelocityYMps);

        /// <summary>The contact state that a stylus would publish on a surface.</summary>
        /// <param name="surface">Material, effects, feature scale and tone of the surface; its motion is ignored.
        /// </param>
        public readonly ContactState ContactOn(in ContactState surface)
        {
            ContactState contact = surface;
            contact.Touching = Touching;
            contact.TouchCounter = TouchCounter;
            contact.FirstVelocityMps = Touching ? (float)VelocityXMps : 0f;
            contact.SecondVelocityMps = Touching ? (float)VelocityYMps : 0f;
            contact.ForceNewtons = Touching ? (float)ForceNewtons : 0f;
            contact.ApproachSpeedMps = (float)LandingSpeedMps;
            contact.EdgeCounter = EdgeCounter;
            contact.EdgeHeightMetres = PresetStrokes.RimHeightMetres;
            // A horizontal plane as the contact model describes it: x is the first axis, the second points along -z.
            contact.HasPlace = Touching;
            contact.PlaceMetres = new PlaceVector((float)WayXMetres, 0f, (float)-WayYMetres);
            contact.FirstAxis = new PlaceVector(1f, 0f, 0f);
            contact.SecondAxis = new PlaceVector(0f, 0f, -1f);
            return contact;
        }
    }
}
