#nullable enable

namespace HaptoFlow.Preview
{
    /// <summary>Position, velocity and force of the tip at one time. Positions are relative to the patch's lower left
    /// corner; x is the surface's first axis, to the right, y the second, upwards.</summary>
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

        /// <summary>Time since the start of the stroke.</summary>
        public double TimeSeconds { get; }

        public double XMetres { get; }

        public double YMetres { get; }

        public double VelocityXMps { get; }

        public double VelocityYMps { get; }

        public double ForceNewtons { get; }

        public bool Touching { get; }

        /// <summary>Increases by one at each touch-down.</summary>
        public uint TouchCounter { get; }

        /// <summary>True if the previous state is of the same touch and the path did not wrap in between.</summary>
        public bool Continues { get; }

        /// <summary>Normal speed at the touch-down.</summary>
        public double LandingSpeedMps { get; }

        /// <summary>Increases by one at each rim.</summary>
        public uint EdgeCounter { get; }

        public double SpeedMps => System.Math.Sqrt(VelocityXMps * VelocityXMps + VelocityYMps * VelocityYMps);

        /// <summary>The contact state that a stylus would publish on a surface.</summary>
        /// <param name="surface">Material, effects, feature scale, tone of the surface; its motion is ignored.</param>
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

    /// <summary>A point of a path before wrapping at the edges of the patch. Units as in <see cref="StrokeState"/>.
    /// </summary>
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
