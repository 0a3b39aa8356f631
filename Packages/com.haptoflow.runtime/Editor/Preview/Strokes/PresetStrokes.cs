#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>Makes strokes from settings.</summary>
    internal static class PresetStrokes
    {
        /// <summary>Before the first touch-down.</summary>
        public const double LeadSeconds = 0.1;

        /// <summary>After the last lift-off: the fade is heard and seen.</summary>
        public const double TailSeconds = 0.2;

        /// <summary>Of the rims of <see cref="StrokePreset.Rims"/>: a pen's tip.</summary>
        public const float RimHeightMetres = 0.001f;

        private const double RimPeriodSeconds = 0.25;
        private const double LandingSeconds = 0.02;
        private const double TapSeconds = 0.08;
        private const double TapPeriodSeconds = 0.32;

        private const double CentreX = 0.5 * Stroke.PatchWidthMetres;
        private const double CentreY = 0.5 * Stroke.PatchHeightMetres;

        /// <exception cref="ArgumentException">Of a stroke that is drawn, not made.</exception>
        public static Stroke Make(StrokePreset preset, StrokeSettings settings)
        {
            Func<double, PathPoint> motion = preset switch
            {
                StrokePreset.Slide => seconds => Along(settings, settings.SpeedMps * seconds, settings.SpeedMps),
                StrokePreset.BackAndForth => BackAndForth(settings),
                StrokePreset.Spiral => new SpiralPath(settings).At,
                StrokePreset.Accelerating => Accelerating(settings),
                StrokePreset.Pressing => Pressing(settings),
                StrokePreset.Taps => Taps(settings),
                StrokePreset.Rims => Rims(settings),
                _ => throw new ArgumentException($"{preset} is no preset", nameof(preset)),
            };
            return new Stroke(Touching(motion, settings), LeadSeconds + settings.ContactSeconds + TailSeconds,
                preset != StrokePreset.BackAndForth && preset != StrokePreset.Spiral);
        }

        /// <summary>A point at a distance from where straight strokes begin, moving at a speed along the direction.
        /// </summary>
        internal static PathPoint Along(in StrokeSettings settings, double metres, double speedMps)
        {
            (double x, double y) = Unit(settings.DirectionDegrees);
            return new PathPoint
            {
                XMetres = CentreX + x * (metres - Room(x, y)),
                YMetres = CentreY + y * (metres - Room(x, y)),
                VelocityXMps = x * speedMps,
                VelocityYMps = y * speedMps,
                ForceNewtons = settings.ForceNewtons,
                Touching = true,
            };
        }

        internal static (double X, double Y) Unit(double degrees)
        {
            double radians = degrees * Math.PI / 180.0;
            return (Math.Cos(radians), Math.Sin(radians));
        }

        /// <summary>From the centre towards the edge, with a margin.</summary>
        private static double Room(double x, double y) => 0.86 * Math.Min(
            CentreX / Math.Max(1e-9, Math.Abs(x)), CentreY / Math.Max(1e-9, Math.Abs(y)));

        /// <summary>Around the motion: before and after it the tip is in the air, and it lands and lifts within 20 ms.
        /// </summary>
        private static Func<double, PathPoint> Touching(Func<double, PathPoint> motion, StrokeSettings settings) =>
            seconds =>
            {
                double since = seconds - LeadSeconds;
                PathPoint point = motion(Math.Max(0.0, Math.Min(settings.ContactSeconds, since)));
                point.Touching &= since >= 0.0 && since < settings.ContactSeconds;
                double landing = Math.Min(since, settings.ContactSeconds - since) / LandingSeconds;
                point.ForceNewtons *= Math.Max(0.25, Math.Min(1.0, landing));
                point.LandingSpeedMps = settings.LandingSpeedMps;
                return point;
            };

        /// <summary>x = a sin(w t) with a w = speed; at least two periods fit into the stroke.</summary>
        private static Func<double, PathPoint> BackAndForth(StrokeSettings settings)
        {
            (double x, double y) = Unit(settings.DirectionDegrees);
            double reach = Math.Min(Room(x, y), settings.SpeedMps * settings.ContactSeconds / (4.0 * Math.PI));
            double radiansPerSecond = settings.SpeedMps / reach;
            return seconds => Along(settings, Room(x, y) + reach * Math.Sin(radiansPerSecond * seconds),
                settings.SpeedMps * Math.Cos(radiansPerSecond * seconds));
        }

        private static Func<double, PathPoint> Accelerating(StrokeSettings settings)
        {
            double acceleration = settings.SpeedMps / settings.ContactSeconds;
            return seconds => Along(settings, 0.5 * acceleration * seconds * seconds, acceleration * seconds);
        }

        private static Func<double, PathPoint> Pressing(StrokeSettings settings) => seconds =>
        {
            PathPoint point = Along(settings, settings.SpeedMps * seconds, settings.SpeedMps);
            point.ForceNewtons *= seconds / settings.ContactSeconds;
            return point;
        };

        private static Func<double, PathPoint> Rims(StrokeSettings settings) => seconds =>
        {
            PathPoint point = Along(settings, settings.SpeedMps * seconds, settings.SpeedMps);
            point.EdgeCounter = (uint)(seconds / RimPeriodSeconds);
            return point;
        };

        /// <summary>Half a sine of force every 320 ms.</summary>
        private static Func<double, PathPoint> Taps(StrokeSettings settings) => seconds =>
        {
            PathPoint point = Along(settings, settings.SpeedMps * seconds, settings.SpeedMps);
            double since = seconds % TapPeriodSeconds;
            point.Touching = since < TapSeconds;
            point.ForceNewtons *= Math.Max(0.05, Math.Sin(Math.PI * Math.Min(1.0, since / TapSeconds)));
            return point;
        };
    }
}
