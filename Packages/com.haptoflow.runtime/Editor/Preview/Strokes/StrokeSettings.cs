#nullable enable

namespace HaptoFlow.Preview
{
    /// <summary>Predefined strokes.</summary>
    internal enum StrokePreset
    {
        /// <summary>Constant speed and direction. A path that leaves the patch enters at the opposite edge.</summary>
        Slide = 0,

        /// <summary>Back and forth: full speed in the middle, zero at the turning points.</summary>
        BackAndForth = 1,

        /// <summary>A spiral outwards at constant speed, in all directions.</summary>
        Spiral = 2,

        /// <summary>From rest to full speed in one direction.</summary>
        Accelerating = 3,

        /// <summary>Constant speed with a force that rises from zero.</summary>
        Pressing = 4,

        /// <summary>Short touches during a motion of constant speed.</summary>
        Taps = 5,

        /// <summary>The stroke drawn on the patch.</summary>
        Drawn = 6,

        /// <summary>Constant speed over a row of blocks, with a rim every 250 ms.</summary>
        Rims = 7,
    }

    /// <summary>The parameters of a predefined stroke.</summary>
    internal readonly struct StrokeSettings
    {
        /// <summary>Approach speed of a gentle touch-down, in m/s.</summary>
        public const double DefaultLandingSpeedMps = 0.05;

        public StrokeSettings(double speedMps, double forceNewtons, double directionDegrees, double contactSeconds,
            double landingSpeedMps = DefaultLandingSpeedMps)
        {
            SpeedMps = speedMps;
            ForceNewtons = forceNewtons;
            DirectionDegrees = directionDegrees;
            ContactSeconds = contactSeconds;
            LandingSpeedMps = landingSpeedMps;
        }

        /// <summary>Tangential speed, above 0.</summary>
        public double SpeedMps { get; }

        public double ForceNewtons { get; }

        /// <summary>0 is the surface's first axis, to the right; 90 is the second, upwards.</summary>
        public double DirectionDegrees { get; }

        /// <summary>Time from the first touch-down to the last lift-off.</summary>
        public double ContactSeconds { get; }

        /// <summary>Normal speed at every touch-down.</summary>
        public double LandingSpeedMps { get; }
    }
}
