#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>Velocity of the tip relative to the material of the surface at a point.</summary>
    /// <remarks>The slope of a line through (tip - material point) at the measurements of the last 35 ms. A tip at rest
    /// on a moving surface therefore has velocity zero, and a turning surface contributes its linear velocity plus
    /// angular velocity x arm. Lag: half the window, 15 to 18 ms at 72 to 120 Hz. While the tracker repeats itself for
    /// longer than the hold time, the tip's share fades to zero.</remarks>
    internal sealed class RelativeVelocity
    {
        private const int MinimumMeasurements = 3;

        // Three measurements may span this many windows; two may be as old as the history.
        private const double SparseWindows = 3.0;

        private readonly double[] timesSeconds = new double[TipHistory.Capacity];
        private readonly Double3[] placesMetres = new Double3[TipHistory.Capacity];
        private int count;

        /// <summary>The velocity in world axes, m/s, limited to the maximum speed of the settings; zero with fewer than
        /// two measurements.</summary>
        public Double3 Of(TipHistory history, PoseHistory track, Double3 localPoint)
        {
            double confidence = history.Confidence;
            Double3 velocity = confidence * RecentSlope(history, track, localPoint, true);
            if (track.Moves && confidence < 1.0)
            {
                velocity += (1.0 - confidence) * RecentSlope(history, track, localPoint, false);
            }
            double fastest = history.Settings.MaximumSpeedMps;
            double speed = velocity.Length;
            return speed > fastest ? velocity * (fastest / speed) : velocity;
        }

        /// <summary>Collects positions backwards in time until the window's end or a jump, and returns the slope
        /// through them: of the tip relative to the material at the tip's measurements, or of the material alone at all
        /// frames.</summary>
        private Double3 RecentSlope(TipHistory history, PoseHistory track, Double3 localPoint, bool withTip)
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
            bool isWithinWindow = age <= settings.WindowSeconds || count < 2 ||
                (count < MinimumMeasurements && age <= SparseWindows * settings.WindowSeconds);
            double maximumMetres = settings.MaximumMoveMetres(timesSeconds[count - 1] - timeSeconds);
            return isWithinWindow && Double3.Distance(place, placesMetres[count - 1]) <= maximumMetres;
        }

        /// <summary>Mean of the newer half minus mean of the older half, over their times (Wald 1940). Least squares
        /// assumes exact times; a tracker with its own clock adds errors to the times, which flatten a least-squares
        /// line: by 4 % for 60 Hz tracking in 90 Hz frames.</summary>
        private Double3 Slope()
        {
            // The middle one of an odd number belongs to neither half.
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
