#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Preview
{
    /// <summary>The motion of a tip over the patch, sampled at the update rate of a headset. Immutable; any thread.
    /// </summary>
    internal sealed class Stroke
    {
        public const double PatchWidthMetres = 0.12;
        public const double PatchHeightMetres = 0.08;

        public const double UpdateRateHz = HapticEngineOptions.DefaultUpdateRateHz;

        private readonly StrokeState[] states;

        /// <param name="path">Gives the point at a time in seconds; called once for each update, in order.</param>
        /// <param name="durationSeconds">Includes the time without contact at the end.</param>
        /// <param name="wraps">True if a path that leaves the patch enters again at the opposite edge.</param>
        public Stroke(Func<double, StrokeState> path, double durationSeconds, bool wraps)
        {
            int count = Math.Max(1, (int)Math.Ceiling(durationSeconds * UpdateRateHz - 1e-9));
            states = new StrokeState[count];
            DurationSeconds = count / UpdateRateHz;
            uint touches = 0;
            bool touched = false;
            (double Column, double Row) field = (0.0, 0.0);
            for (int index = 0; index < count; ++index)
            {
                double seconds = index / UpdateRateHz;
                StrokeState point = path(seconds);
                touches += point.Touching && !touched ? 1u : 0u;
                (double Column, double Row) now = (0.0, 0.0);
                (point.WayXMetres, point.WayYMetres) = (point.XMetres, point.YMetres);
                if (wraps)
                {
                    now = (Math.Floor(point.XMetres / PatchWidthMetres), Math.Floor(point.YMetres / PatchHeightMetres));
                    point.XMetres -= now.Column * PatchWidthMetres;
                    point.YMetres -= now.Row * PatchHeightMetres;
                }
                point.TimeSeconds = seconds;
                point.TouchCounter = touches;
                point.Continues = point.Touching && touched && now == field;
                states[index] = point;
                touched = point.Touching;
                field = now;
            }
        }

        /// <summary>One state for each update, the first at 0 s.</summary>
        public IReadOnlyList<StrokeState> States => states;

        public double DurationSeconds { get; }

        public double MaximumSpeedMps => states.Where(state => state.Touching).Select(state => state.SpeedMps)
            .DefaultIfEmpty().Max();

        public double MaximumForceNewtons => states.Where(state => state.Touching).Select(state => state.ForceNewtons)
            .DefaultIfEmpty().Max();

        /// <summary>The latest state at a time.</summary>
        public StrokeState At(double seconds)
        {
            double place = Math.Floor(seconds * UpdateRateHz + 1e-9);
            return states[(int)Math.Max(0.0, Math.Min(states.Length - 1.0, place))];
        }
    }

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

        public double LandingSpeedMps;

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

    internal enum StrokePreset
    {
        /// <summary>Constant speed and direction. A path that leaves the patch enters at the opposite edge.</summary>
        Slide = 0,

        /// <summary>Back and forth: full speed in the middle, zero at the turning points.</summary>
        BackAndForth = 1,

        Spiral = 2,

        Accelerating = 3,

        /// <summary>Constant speed with a force that rises from zero.</summary>
        Pressing = 4,

        Taps = 5,

        Drawn = 6,

        /// <summary>Constant speed over a row of blocks, with a rim every 250 ms.</summary>
        Rims = 7,
    }

    /// <param name="DirectionDegrees">0 is the surface's first axis, to the right; 90 is the second, upwards.</param>
    /// <param name="ContactSeconds">Time from the first touch-down to the last lift-off.</param>
    internal sealed record StrokeSettings(double SpeedMps, double ForceNewtons, double DirectionDegrees,
        double ContactSeconds, double LandingSpeedMps = StrokeSettings.DefaultLandingSpeedMps)
    {
        /// <summary>Approach speed of a gentle touch-down, in m/s.</summary>
        public const double DefaultLandingSpeedMps = 0.05;
    }
}
