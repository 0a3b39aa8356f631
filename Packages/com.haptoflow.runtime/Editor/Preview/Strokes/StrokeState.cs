#nullable enable

namespace HaptoFlow.Preview
{
    /// <summary>Where the tip is on the patch at one moment and how it moves. Metres from the patch's lower left
    /// corner, x to the right along the first axis of the surface, y upwards along the second.</summary>
    internal readonly struct StrokeState
    {
        public StrokeState(double timeSeconds, in PathPoint point, uint touchCounter, bool continues)
        {
            TimeSeconds = timeSeconds;
            XMetres = point.XMetres;
            YMetres = point.YMetres;
            VelocityXMps = point.VelocityXMps;
            VelocityYMps = point.VelocityYMps;
            ForceNewtons = point.ForceNewtons;
            Touching = point.Touching;
            TouchCounter = touchCounter;
            Continues = continues;
            LandingSpeedMps = point.LandingSpeedMps;
            EdgeCounter = point.EdgeCounter;
        }

        /// <summary>Since the stroke began.</summary>
        public double TimeSeconds { get; }

        public double XMetres { get; }

        public double YMetres { get; }

        public double VelocityXMps { get; }

        public double VelocityYMps { get; }

        public double ForceNewtons { get; }

        public bool Touching { get; }

        /// <summary>One more at each touch-down.</summary>
        public uint TouchCounter { get; }

        /// <summary>A line leads here from the state before: the same touch, and no step over the patch's edge.
        /// </summary>
        public bool Continues { get; }

        /// <summary>Into the surface, at the touch-down.</summary>
        public double LandingSpeedMps { get; }

        /// <summary>One more at each rim.</summary>
        public uint EdgeCounter { get; }

        public double SpeedMps => System.Math.Sqrt(VelocityXMps * VelocityXMps + VelocityYMps * VelocityYMps);

        /// <summary>What a stylus would publish on such a surface.</summary>
        /// <param name="surface">What the surface says: material, effects, scale and tone. Its motion is not read.
        /// </param>
        public ContactState ContactOn(in ContactState surface)
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
            return contact;
        }
    }

    /// <summary>A point of a path before it is laid onto the patch. Units as in <see cref="StrokeState"/>.</summary>
    internal struct PathPoint
    {
        public double XMetres;
        public double YMetres;
        public double VelocityXMps;
        public double VelocityYMps;
        public double ForceNewtons;
        public bool Touching;
        public double LandingSpeedMps;
        public uint EdgeCounter;
    }
}
