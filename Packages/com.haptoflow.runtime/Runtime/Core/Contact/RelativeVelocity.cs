#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>Velocity of the tip relative to the surface's material at a point.</summary>
    /// <remarks>The slope of the straight line through (tip - material point) at the measurements of the last 35 ms, so
    /// that a tip riding on a surface reads zero however both move, and a turning surface counts with its linear
    /// velocity plus angular velocity x arm. Lag: half the window, 15 to 18 ms at 72 to 120 Hz. While the tracker
    /// repeats itself for longer than the hold time, the tip's share fades to zero.</remarks>
    internal sealed class RelativeVelocity
    {
        private const int FewestMeasurements = 3;

        // Three measurements may be this many windows old, two may be as old as the history.
        private const double SparseWindows = 3.0;

        private readonly double[] timesSeconds = new double[TipHistory.Capacity];
        private readonly Double3[] placesMetres = new Double3[TipHistory.Capacity];
        private int count;

        /// <summary>In world axes, m/s. Never faster than the fastest speed of the settings; zero with fewer than two
        /// measurements.</summary>
        public Double3 Of(TipHistory history, SurfaceTrack track, Double3 localPoint)
        {
            double confidence = history.Confidence;
            Double3 velocity = confidence * RecentSlope(history, track, localPoint, true);
            if (track.Moves && confidence < 1.0)
            {
                velocity += (1.0 - confidence) * RecentSlope(history, track, localPoint, false);
            }
            double fastest = history.Settings.FastestMps;
            double speed = velocity.Length;
            return speed > fastest ? velocity * (fastest / speed) : velocity;
        }

        /// <summary>Walks back over the frames and draws a line through the places, down to the window's end or to a
        /// jump that no motion explains. Of the tip relative to the material at its measurements, or of a tip that
        /// rests at all frames.</summary>
        private Double3 RecentSlope(TipHistory history, SurfaceTrack track, Double3 localPoint, bool withTip)
        {
            VelocitySettings settings = history.Settings;
            count = 0;
            for (int age = 0; age < history.Count; ++age)
            {
                ref readonly TipFrame frame = ref history.Newest(age);
                if ((withTip && !frame.Fresh) || (track.Moves && !track.Knows(frame.TimeSeconds)))
                {
                    continue;
                }
                Double3 place = withTip ? frame.PositionMetres : Double3.Zero;
                if (track.Moves)
                {
                    place -= track.PoseAt(frame.TimeSeconds).PointToWorld(localPoint);
                }
                if (count > 0 && !Continues(settings, frame.TimeSeconds, place))
                {
                    break;
                }
                timesSeconds[count] = frame.TimeSeconds;
                placesMetres[count] = place;
                ++count;
            }
            return Slope();
        }

        private bool Continues(VelocitySettings settings, double timeSeconds, Double3 place)
        {
            double age = timesSeconds[0] - timeSeconds;
            bool wanted = age <= settings.WindowSeconds || count < 2 ||
                (count < FewestMeasurements && age <= SparseWindows * settings.WindowSeconds);
            double longestMetres = settings.MaximumMoveMetres(timesSeconds[count - 1] - timeSeconds);
            return wanted && Double3.Distance(place, placesMetres[count - 1]) <= longestMetres;
        }

        /// <summary>Mean of the newer half minus mean of the older half, by their times (Wald 1940). Least squares
        /// would do for exact times, but a tracker with a clock of its own puts errors into the times, which flattens a
        /// least-squares line: by 4 % at 60 Hz in 90.</summary>
        private Double3 Slope()
        {
            // Of an odd number the middle one belongs to neither half.
            int half = count / 2;
            double seconds = 0.0;
            Double3 distance = Double3.Zero;
            for (int index = 0; index < half; ++index)
            {
                int older = count - 1 - index;
                seconds += timesSeconds[index] - timesSeconds[older];
                distance += placesMetres[index] - placesMetres[older];
            }
            return seconds > 0.0 ? distance / seconds : Double3.Zero;
        }
    }
}
