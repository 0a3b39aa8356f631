#nullable enable
using System;

namespace HaptoFlow.Preview
{
    internal static class PresetStrokes
    {
        public const double LeadSeconds = 0.1;

        /// <summary>Time after the last lift-off, for the fade.</summary>
        public const double TailSeconds = 0.2;

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
        internal static StrokeState Along(StrokeSettings settings, double metres, double speedMps)
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

    /// <summary>An Archimedean spiral r = k phi at constant speed. Its length up to phi is k / 2 (phi sqrt(1 + phi^2) +
    /// asinh phi).</summary>
    internal sealed class SpiralPath
    {
        private const double InnerMetres = 0.006;
        private const double OuterMetres = 0.4 * Stroke.PatchHeightMetres;

        private readonly StrokeSettings settings;
        private readonly double metresPerRadian;
        private readonly double innerRadians;
        private readonly double direction;

        public SpiralPath(StrokeSettings settings)
        {
            this.settings = settings;
            // The stroke goes from the inner to the outer radius; its length is about (r1^2 - r0^2) / 2 k.
            double length = settings.SpeedMps * settings.ContactSeconds;
            metresPerRadian = (OuterMetres * OuterMetres - InnerMetres * InnerMetres) / (2.0 * length);
            innerRadians = InnerMetres / metresPerRadian;
            direction = settings.DirectionDegrees * Math.PI / 180.0;
        }

        public StrokeState At(double seconds)
        {
            double radians = Turned(Length(innerRadians) + settings.SpeedMps * seconds);
            double radius = metresPerRadian * radians;
            double angle = direction + radians - innerRadians;
            double scale = settings.SpeedMps / Math.Sqrt(1.0 + radians * radians);
            return new StrokeState
            {
                XMetres = 0.5 * Stroke.PatchWidthMetres + radius * Math.Cos(angle),
                YMetres = 0.5 * Stroke.PatchHeightMetres + radius * Math.Sin(angle),
                VelocityXMps = scale * (Math.Cos(angle) - radians * Math.Sin(angle)),
                VelocityYMps = scale * (Math.Sin(angle) + radians * Math.Cos(angle)),
                ForceNewtons = settings.ForceNewtons,
                Touching = true,
            };
        }

        private double Length(double radians)
        {
            double root = Math.Sqrt(1.0 + radians * radians);
            return 0.5 * metresPerRadian * (radians * root + Math.Log(radians + root));
        }

        /// <summary>The angle phi at a length, by Newton's method.</summary>
        private double Turned(double length)
        {
            double radians = Math.Sqrt(2.0 * length / metresPerRadian);
            for (int round = 0; round < 12; ++round)
            {
                radians -= (Length(radians) - length) / (metresPerRadian * Math.Sqrt(1.0 + radians * radians));
            }
            return Math.Max(0.0, radians);
        }
    }
}
