#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Preview
{
    /// <summary>A tip's way over the patch at the rate at which a headset would report it. Immutable: any thread.
    /// </summary>
    internal sealed class Stroke
    {
        public const double PatchWidthMetres = 0.12;
        public const double PatchHeightMetres = 0.08;

        /// <summary>Contact states a second.</summary>
        public const double UpdateRateHz = HapticEngineOptions.DefaultUpdateRateHz;

        private readonly StrokeState[] states;

        /// <param name="path">Point at a time in seconds; asked once for each update, in order.</param>
        /// <param name="durationSeconds">Up to and with the silence at the end.</param>
        /// <param name="wraps">A path that leaves the patch comes in again at the other side.</param>
        public Stroke(Func<double, PathPoint> path, double durationSeconds, bool wraps)
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
                PathPoint point = path(seconds);
                touches += point.Touching && !touched ? 1u : 0u;
                (double Column, double Row) now = (0.0, 0.0);
                if (wraps)
                {
                    now = (Math.Floor(point.XMetres / PatchWidthMetres), Math.Floor(point.YMetres / PatchHeightMetres));
                    point.XMetres -= now.Column * PatchWidthMetres;
                    point.YMetres -= now.Row * PatchHeightMetres;
                }
                bool continues = point.Touching && touched && now == field;
                states[index] = new StrokeState(seconds, point, touches, continues);
                touched = point.Touching;
                field = now;
            }
        }

        /// <summary>One for each update, the first at 0 s.</summary>
        public IReadOnlyList<StrokeState> States => states;

        public double DurationSeconds { get; }

        public double FastestMps => states.Where(state => state.Touching).Select(state => state.SpeedMps)
            .DefaultIfEmpty().Max();

        public double StrongestNewtons => states.Where(state => state.Touching).Select(state => state.ForceNewtons)
            .DefaultIfEmpty().Max();

        /// <summary>The last state that was published by then.</summary>
        public StrokeState At(double seconds)
        {
            double place = Math.Floor(seconds * UpdateRateHz + 1e-9);
            return states[(int)Math.Max(0.0, Math.Min(states.Length - 1.0, place))];
        }
    }
}
