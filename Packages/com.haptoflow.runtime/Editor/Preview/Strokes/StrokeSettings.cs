#nullable enable

namespace HaptoFlow.Preview
{
    /// <summary>Strokes that are always at hand.</summary>
    internal enum StrokePreset
    {
        /// <summary>One speed, one direction. What leaves the patch comes in again at the other side.</summary>
        Slide = 0,

        /// <summary>To and fro; the speed is the one in the middle, and zero at the turns.</summary>
        BackAndForth = 1,

        /// <summary>One speed, all directions, from the inside outwards.</summary>
        Spiral = 2,

        /// <summary>From rest to the speed, in one direction.</summary>
        Accelerating = 3,

        /// <summary>One speed; the force grows from nothing.</summary>
        Pressing = 4,

        /// <summary>Short touches while the hand moves on.</summary>
        Taps = 5,

        /// <summary>What was drawn on the patch.</summary>
        Drawn = 6,

        /// <summary>One speed over a row of blocks: a rim every 250 ms.</summary>
        Rims = 7,
    }

    /// <summary>What a preset is made from.</summary>
    internal readonly struct StrokeSettings
    {
        /// <summary>A hand that lands gently, in m/s.</summary>
        public const double UsualLandingSpeedMps = 0.05;

        public StrokeSettings(double speedMps, double forceNewtons, double directionDegrees, double contactSeconds,
            double landingSpeedMps = UsualLandingSpeedMps)
        {
            SpeedMps = speedMps;
            ForceNewtons = forceNewtons;
            DirectionDegrees = directionDegrees;
            ContactSeconds = contactSeconds;
            LandingSpeedMps = landingSpeedMps;
        }

        /// <summary>Along the surface, above 0.</summary>
        public double SpeedMps { get; }

        public double ForceNewtons { get; }

        /// <summary>0 is along the surface's first axis, to the right; 90 along the second, upwards.</summary>
        public double DirectionDegrees { get; }

        /// <summary>From the first touch-down to the last lift-off.</summary>
        public double ContactSeconds { get; }

        /// <summary>Into the surface, at every touch-down.</summary>
        public double LandingSpeedMps { get; }
    }
}
