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

    /// <summary>A position of the pointer while it was pressed. Has fields, which Unity serializes.</summary>
    [Serializable]
    internal struct DrawnPoint
    {
        public float TimeSeconds;

        /// <summary>Distance from the patch's lower left corner.</summary>
        public float XMetres;

        /// <summary>Distance from the patch's lower left corner.</summary>
        public float YMetres;

        public float ForceNewtons;

        public bool Lands;
    }

    /// <summary>Collects pointer events, and converts them to a stroke at the engine's update rate.</summary>
    internal sealed class DrawnStroke
    {
        // The runtime estimates velocity from tracked positions over the same window.
        private const double VelocityWindowSeconds = 0.035;

        // A resting pointer sends no events. After a gap of RestSeconds, the motion began EventSeconds before the new
        // event.
        private const float RestSeconds = 0.03f;
        private const float EventSeconds = 0.008f;
        private const float PauseSeconds = 0.15f;
        private const double MaximumSeconds = 20.0;

        private readonly List<DrawnPoint> points = new List<DrawnPoint>();
        private double beganSeconds;

        public IReadOnlyList<DrawnPoint> Points => points;

        /// <summary>Starts a touch.</summary>
        /// <param name="clockSeconds">Time of any monotonic clock.</param>
        /// <param name="before">Touches before this one; empty for a new stroke.</param>
        public void Begin(
            double clockSeconds, double xMetres, double yMetres, double forceNewtons, IEnumerable<DrawnPoint> before)
        {
            points.Clear();
            points.AddRange(before);
            float start = points.Count > 0 ? points[points.Count - 1].TimeSeconds + PauseSeconds : 0f;
            beganSeconds = clockSeconds - start;
            points.Add(Point(start, xMetres, yMetres, forceNewtons, true));
        }

        /// <summary>Adds a position of the pressed pointer, unless the stroke is longer than 20 s.</summary>
        public void Move(double clockSeconds, double xMetres, double yMetres, double forceNewtons)
        {
            DrawnPoint last = points[points.Count - 1];
            var seconds = (float)(clockSeconds - beganSeconds);
            if (!(seconds > last.TimeSeconds) || seconds > MaximumSeconds)
            {
                return;
            }
            if (seconds - last.TimeSeconds > RestSeconds)
            {
                DrawnPoint rested = last;
                rested.TimeSeconds = seconds - EventSeconds;
                rested.Lands = false;
                points.Add(rested);
            }
            points.Add(Point(seconds, xMetres, yMetres, forceNewtons, false));
        }

        /// <summary>The stroke of these points; without contact if there are none.</summary>
        public static Stroke Of(IEnumerable<DrawnPoint> points)
        {
            DrawnPoint[] drawn = points.ToArray();
            double last = drawn.Length > 0 ? drawn[drawn.Length - 1].TimeSeconds : 0.0;
            double duration = PresetStrokes.LeadSeconds + last + PresetStrokes.TailSeconds;
            return new Stroke(seconds => At(drawn, seconds - PresetStrokes.LeadSeconds), duration, false);
        }

        private static StrokeState At(DrawnPoint[] drawn, double seconds)
        {
            (int first, int end) = TouchAt(drawn, seconds);
            if (end - first < 2)
            {
                return default;
            }
            double from = Math.Max(drawn[first].TimeSeconds, seconds - 0.5 * VelocityWindowSeconds);
            double to = Math.Min(drawn[end - 1].TimeSeconds, seconds + 0.5 * VelocityWindowSeconds);
            DrawnPoint before = Between(drawn, first, end, from);
            DrawnPoint after = Between(drawn, first, end, to);
            DrawnPoint now = Between(drawn, first, end, seconds);
            double window = Math.Max(1e-3, to - from);
            return new StrokeState
            {
                XMetres = now.XMetres,
                YMetres = now.YMetres,
                VelocityXMps = (after.XMetres - before.XMetres) / window,
                VelocityYMps = (after.YMetres - before.YMetres) / window,
                ForceNewtons = now.ForceNewtons,
                Touching = true,
                LandingSpeedMps = StrokeSettings.DefaultLandingSpeedMps,
            };
        }

        /// <summary>Indices of the points of the touch at a time; an empty range between touches.</summary>
        private static (int First, int End) TouchAt(DrawnPoint[] drawn, double seconds)
        {
            int first = Array.FindLastIndex(drawn, point => point.Lands && point.TimeSeconds <= seconds);
            int next = first < 0 ? -1 : Array.FindIndex(drawn, first + 1, point => point.Lands);
            int end = next < 0 ? drawn.Length : next;
            return first >= 0 && drawn[end - 1].TimeSeconds >= seconds ? (first, end) : (0, 0);
        }

        private static DrawnPoint Between(DrawnPoint[] drawn, int first, int end, double seconds)
        {
            int after = Array.FindIndex(drawn, first, end - first, point => point.TimeSeconds >= seconds);
            int next = after < 0 ? end - 1 : after;
            DrawnPoint to = drawn[next];
            DrawnPoint from = drawn[Math.Max(first, next - 1)];
            double span = to.TimeSeconds - from.TimeSeconds;
            var share = (float)(span > 0.0 ? Math.Max(0.0, Math.Min(1.0, (seconds - from.TimeSeconds) / span)) : 1.0);
            to.XMetres = from.XMetres + share * (to.XMetres - from.XMetres);
            to.YMetres = from.YMetres + share * (to.YMetres - from.YMetres);
            to.ForceNewtons = from.ForceNewtons + share * (to.ForceNewtons - from.ForceNewtons);
            return to;
        }

        private static DrawnPoint Point(double seconds, double xMetres, double yMetres, double newtons, bool lands) =>
            new DrawnPoint
            {
                TimeSeconds = (float)seconds,
                XMetres = (float)Math.Max(0.0, Math.Min(Stroke.PatchWidthMetres, xMetres)),
                YMetres = (float)Math.Max(0.0, Math.Min(Stroke.PatchHeightMetres, yMetres)),
                ForceNewtons = (float)Math.Max(0.0, newtons),
                Lands = lands,
            };
    }
}
