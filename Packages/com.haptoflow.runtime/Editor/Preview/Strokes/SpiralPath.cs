#nullable enable
using System;

namespace HaptoFlow.Preview
{
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

        public SpiralPath(in StrokeSettings settings)
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
