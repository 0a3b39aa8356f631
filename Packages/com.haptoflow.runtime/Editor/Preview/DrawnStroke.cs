#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Preview
{
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
