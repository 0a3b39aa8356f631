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

        /// <summary>Contact states per second.</summary>
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
}
