#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>Makes strokes from settings.</summary>
    internal static class PresetStrokes
    {
        /// <summary>Time before the first touch-down.</summary>
        public const double LeadSeconds = 0.1;

        /// <summary>Time after the last lift-off, for the fade.</summary>
        public const double TailSeconds = 0.2;

        /// <summary>Height of the rims of <see cref="StrokePreset.Rims"/>.</summary>
        public const float RimHeightMetres = 0.001f;

        private const double RimPeriodSeconds = 0.25;
        private const double LandingSeconds = 0.02;
        private const double TapSeconds = 0.08;
        private const double TapPeriodSeconds = 0.32;

        private const double CentreX = 0.5 * Stroke.PatchWidthMetres;
        private const double CentreY = 0.5 * Stroke.PatchHeightMetres;

        /// <exception cref="ArgumentException">The preset is <see cref="StrokePreset.Drawn"/>.</exception>
        public static Stroke Make(StrokePreset preset, StrokeSettings settings)
        {
            Func<double, StrokeState> motion = preset switch
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

        /// <summary>A point of a straight stroke.</summary>
        /// <param name="metres">Distance from its start.</param>
        internal static StrokeState Along(in StrokeSettings settings, double metres, double speedMps)
        {
            (double x, double y) = Unit(settings.DirectionDegrees);
            return new StrokeState
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

        /// <summary>Distance from the centre towards the edge of the patch, less a margin.</summary>
        private static double Room(double x, double y) => 0.86 * Math.Min(
            CentreX / Math.Max(1e-9, Math.Abs(x)), CentreY / Math.Max(1e-9, Math.Abs(y)));

        /// <summary>Adds touch-down and lift-off, during which the force ramps for 20 ms, and time without contact
        /// before and after.</summary>
        private static Func<double, StrokeState> Touching(Func<double, StrokeState> motion, StrokeSettings settings) =>
            seconds =>
            {
                double since = seconds - LeadSeconds;
                StrokeState point = motion(Math.Max(0.0, Math.Min(settings.ContactSeconds, since)));
                point.Touching &= since >= 0.0 && since < settings.ContactSeconds;
                double landing = Math.Min(since, settings.ContactSeconds - since) / LandingSeconds;
                point.ForceNewtons *= Math.Max(0.25, Math.Min(1.0, landing));
                point.LandingSpeedMps = settings.LandingSpeedMps;
                return point;
            };

        /// <summary>x = a sin(w t) with a w = speed, where a is small enough for two periods.</summary>
        private static Func<double, StrokeState> BackAndForth(StrokeSettings settings)
        {
            (double x, double y) = Unit(settings.DirectionDegrees);
            double reach = Math.Min(Room(x, y), settings.SpeedMps * settings.ContactSeconds / (4.0 * Math.PI));
            double radiansPerSecond = settings.SpeedMps / reach;
            return seconds => Along(settings, Room(x, y) + reach * Math.Sin(radiansPerSecond * seconds),
                settings.SpeedMps * Math.Cos(radiansPerSecond * seconds));
        }

        private static Func<double, StrokeState> Accelerating(StrokeSettings settings)
        {
            double acceleration = settings.SpeedMps / settings.ContactSeconds;
            return seconds => Along(settings, 0.5 * acceleration * seconds * seconds, acceleration * seconds);
        }

        private static Func<double, StrokeState> Pressing(StrokeSettings settings) => seconds =>
        {
            StrokeState point = Along(settings, settings.SpeedMps * seconds, settings.SpeedMps);
            point.ForceNewtons *= seconds / settings.ContactSeconds;
            return point;
        };

        private static Func<double, StrokeState> Rims(StrokeSettings settings) => seconds =>
        {
            StrokeState point = Along(settings, settings.SpeedMps * seconds, settings.SpeedMps);
            point.EdgeCounter = (uint)(seconds / RimPeriodSeconds);
            return point;
        };

        /// <summary>The force is half a sine of 80 ms, every 320 ms.</summary>
        private static Func<double, StrokeState> Taps(StrokeSettings settings) => seconds =>
        {
            StrokeState point = Along(settings, settings.SpeedMps * seconds, settings.SpeedMps);
            double since = seconds % TapPeriodSeconds;
            point.Touching = since < TapSeconds;
            point.ForceNewtons *= Math.Max(0.05, Math.Sin(Math.PI * Math.Min(1.0, since / TapSeconds)));
            return point;
        };
    }
}
