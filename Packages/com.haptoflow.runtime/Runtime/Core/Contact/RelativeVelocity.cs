#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>The surface's axes, m/s, of the tip relative to the surface.</summary>
    internal readonly struct TipVelocity
    {
        /// <summary>At the newest measurement, for what is felt now.</summary>
        public readonly Double3 NowMps;

        /// <summary>Mean of the last <see cref="VelocitySettings.ApproachSeconds"/>: how the tip came to where it is,
        /// for what it meets there.</summary>
        public readonly Double3 ApproachMps;

        public TipVelocity(Double3 nowMps, Double3 approachMps) => (NowMps, ApproachMps) = (nowMps, approachMps);
    }

    /// <summary>Velocity of the tip's path over a surface, by <see cref="GrowingFit"/>.</summary>
    /// <remarks>A tip that moves along with a surface has velocity zero, and under a tip at rest a turning surface gives
    /// its linear velocity plus angular velocity x arm. While the tracker repeats itself for longer than the hold time,
    /// the velocity fades to that of a tip which is held there: zero on a surface at rest.</remarks>
    internal sealed class RelativeVelocity
    {
        private const int MinimumMeasurements = 2;

        private readonly GrowingFit fit = new GrowingFit();

        /// <summary>Each velocity is limited to the maximum speed of the settings; zero with fewer than two
        /// measurements.</summary>
        public TipVelocity Of(TipPath path)
        {
            double confidence = path.Confidence;
            TipVelocity velocity = Velocity(path, double.NegativeInfinity);
            if (confidence < 1.0)
            {
                TipVelocity held = Velocity(path, path.MeasuredSeconds);
                velocity = new TipVelocity(
                    confidence * velocity.NowMps + (1.0 - confidence) * held.NowMps,
                    confidence * velocity.ApproachMps + (1.0 - confidence) * held.ApproachMps);
            }
            double fastest = path.Settings.MaximumSpeedMps;
            return new TipVelocity(Limited(velocity.NowMps, fastest), Limited(velocity.ApproachMps, fastest));
        }

        /// <summary>Collects positions backwards in time until the longest window's end or a jump, and returns their
        /// velocity: of the measurements, or of all frames since <paramref name="heldSinceSeconds"/>.</summary>
        private TipVelocity Velocity(TipPath path, double heldSinceSeconds)
        {
            bool isHeld = heldSinceSeconds > double.NegativeInfinity;
            VelocitySettings settings = path.Settings;
            fit.Clear();
            for (int age = 0; age < path.Count && !fit.IsFull; ++age)
            {
                ref readonly TipFrame frame = ref path.Newest(age);
                if (isHeld ? frame.TimeSeconds < heldSinceSeconds : !frame.Fresh)
                {
                    continue;
                }
                if (fit.Count > 0 && !Continues(settings, frame.TimeSeconds, frame.PositionMetres))
                {
                    break;
                }
                fit.Add(frame.TimeSeconds, frame.PositionMetres);
            }
            Double3 mean = fit.MeanVelocity(settings.ApproachSeconds);
            return new TipVelocity(path.IsSlow ? mean : fit.EndVelocity(path.NoiseMetres), mean);
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
