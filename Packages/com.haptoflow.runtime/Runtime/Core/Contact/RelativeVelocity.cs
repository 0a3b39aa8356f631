#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>World axes, m/s, of the tip relative to the surface's material.</summary>
    internal readonly struct TipVelocity
    {
        /// <summary>At the newest measurement, for what is felt now.</summary>
        public readonly Double3 NowMps;

        /// <summary>Mean of the last <see cref="VelocitySettings.ApproachSeconds"/>: how the tip came to where it is,
        /// for what it meets there.</summary>
        public readonly Double3 ApproachMps;

        public TipVelocity(Double3 nowMps, Double3 approachMps) => (NowMps, ApproachMps) = (nowMps, approachMps);
    }

    /// <summary>Velocity of the tip relative to the material of the surface at a point.</summary>
    /// <remarks>By <see cref="GrowingFit"/> through (tip - material point). A tip at rest on a moving surface therefore
    /// has velocity zero, and a turning surface contributes its linear velocity plus angular velocity x arm. While the
    /// tracker repeats itself for longer than the hold time, the tip's share fades to zero.</remarks>
    internal sealed class RelativeVelocity
    {
        private const int MinimumMeasurements = 2;

        private readonly GrowingFit fit = new GrowingFit();

        /// <summary>Each velocity is limited to the maximum speed of the settings; zero with fewer than two
        /// measurements.</summary>
        public TipVelocity Of(TipHistory history, PoseHistory track, Double3 localPoint)
        {
            double confidence = history.Confidence;
            TipVelocity measured = Velocity(history, track, localPoint, true);
            Double3 now = confidence * measured.NowMps;
            Double3 approach = confidence * measured.ApproachMps;
            if (track.Moves && confidence < 1.0)
            {
                TipVelocity own = Velocity(history, track, localPoint, false);
                now += (1.0 - confidence) * own.NowMps;
                approach += (1.0 - confidence) * own.ApproachMps;
            }
            double fastest = history.Settings.MaximumSpeedMps;
            return new TipVelocity(Limited(now, fastest), Limited(approach, fastest));
        }

        /// <summary>Collects positions backwards in time until the longest window's end or a jump, and returns their
        /// velocity: of the tip relative to the material at the tip's measurements, or of the material alone at all
        /// frames.</summary>
        private TipVelocity Velocity(TipHistory history, PoseHistory track, Double3 localPoint, bool withTip)
        {
            VelocitySettings settings = history.Settings;
            fit.Clear();
            for (int age = 0; age < history.Count && !fit.IsFull; ++age)
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
                if (fit.Count > 0 && !Continues(settings, frame.TimeSeconds, place))
                {
                    break;
                }
                fit.Add(frame.TimeSeconds, place);
            }
            Double3 mean = fit.MeanVelocity(settings.ApproachSeconds);
            return new TipVelocity(history.IsSlow ? mean : fit.EndVelocity(history.NoiseMetres), mean);
        }

        private bool Continues(VelocitySettings settings, double timeSeconds, Double3 place)
        {
            bool isWanted = fit.Count < MinimumMeasurements ||
                fit.NewestSeconds - timeSeconds <= settings.WindowSeconds;
            double maximumMetres = settings.MaximumMoveMetres(fit.OldestSeconds - timeSeconds);
            return isWanted && Double3.Distance(place, fit.OldestMetres) <= maximumMetres;
        }

        private static Double3 Limited(Double3 velocity, double fastest)
        {
            double speed = velocity.Length;
            return speed > fastest ? velocity * (fastest / speed) : velocity;
        }
    }
}
