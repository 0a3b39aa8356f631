#nullable enable
using System;
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

        /// <summary>Each velocity is limited to the maximum speed; zero with fewer than two
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
            double fastest = VelocitySettings.MaximumSpeedMps;
            return new TipVelocity(Limited(velocity.NowMps, fastest), Limited(velocity.ApproachMps, fastest));
        }

        /// <summary>Collects positions backwards in time until the longest window's end or a jump, and returns their
        /// velocity: of the measurements, or of all frames since <paramref name="heldSinceSeconds"/>.</summary>
        private TipVelocity Velocity(TipPath path, double heldSinceSeconds)
        {
            bool isHeld = heldSinceSeconds > double.NegativeInfinity;
            fit.Clear();
            for (int age = 0; age < path.Count && !fit.IsFull; ++age)
            {
                ref readonly TipFrame frame = ref path.Newest(age);
                if (isHeld ? frame.TimeSeconds < heldSinceSeconds : !frame.Fresh)
                {
                    continue;
                }
                if (fit.Count > 0 && !Continues(frame.TimeSeconds, frame.PositionMetres))
                {
                    break;
                }
                fit.Add(frame.TimeSeconds, frame.PositionMetres);
            }
            Double3 mean = fit.MeanVelocity(VelocitySettings.ApproachSeconds);
            return new TipVelocity(path.IsSlow ? mean : fit.EndVelocity(path.NoiseMetres), mean);
        }

        private bool Continues(double timeSeconds, Double3 place)
        {
            bool isWanted = fit.Count < MinimumMeasurements ||
                fit.NewestSeconds - timeSeconds <= VelocitySettings.WindowSeconds;
            double maximumMetres = VelocitySettings.MaximumMoveMetres(fit.OldestSeconds - timeSeconds);
            return isWanted && Double3.Distance(place, fit.OldestMetres) <= maximumMetres;
        }

        private static Double3 Limited(Double3 velocity, double fastest)
        {
            double speed = velocity.Length;
            return speed > fastest ? velocity * (fastest / speed) : velocity;
        }
    }

    /// <summary>How noisy a tracker's places are, from the places themselves.</summary>
    /// <remarks>A hand moves smoothly over four measurements, so that their third difference is mostly noise. A sudden
    /// movement makes it larger for a moment. The estimate therefore follows a low quantile, which such moments hardly
    /// change, by small steps (Robbins and Monro 1951).</remarks>
    internal sealed class TrackerNoise
    {
        private const int Needed = 4;
        private const double LeastMetres = 5e-6;
        private const double MostMetres = 500e-6;
        private const double Quantile = 0.35;

        // That quantile of the length of three standard normal numbers.
        private const double QuantileLength = 1.2812;
        private const double Step = 0.1;

        private readonly double[] timesSeconds = new double[Needed];
        private readonly Double3[] placesMetres = new Double3[Needed];
        private int count;

        /// <summary>On each axis.</summary>
        public double Metres { get; private set; } = 50e-6;

        /// <summary>Forgets the measurements, not what was learnt from them.</summary>
        public void Restart() => count = 0;

        /// <summary>Adds a measurement, in the frame after the last one's.</summary>
        public void Add(double timeSeconds, Double3 placeMetres)
        {
            Array.Copy(timesSeconds, 0, timesSeconds, 1, Needed - 1);
            Array.Copy(placesMetres, 0, placesMetres, 1, Needed - 1);
            timesSeconds[0] = timeSeconds;
            placesMetres[0] = placeMetres;
            count = Math.Min(count + 1, Needed);
            if (count < Needed)
            {
                return;
            }
            double seconds = timesSeconds[0] - timesSeconds[3];
            Double3 difference = Double3.Zero;
            double norm = 0.0;
            for (int index = 0; index < Needed; ++index)
            {
                // Divided by the time from first to last, because the cubes of seconds would make the weights huge.
                double weight = 1.0;
                for (int other = 0; other < Needed; ++other)
                {
                    if (other != index)
                    {
                        weight *= seconds / (timesSeconds[index] - timesSeconds[other]);
                    }
                }
                norm += weight * weight;
                difference += weight * (placesMetres[index] - placesMetres[0]);
            }
            bool isAbove = difference.Length > QuantileLength * Metres * Math.Sqrt(norm);
            Metres = Vectors.Clamp(
                Metres * (isAbove ? 1.0 + Step * Quantile : 1.0 - Step * (1.0 - Quantile)), LeastMetres, MostMetres);
        }
    }

    /// <summary>Places at times, and the velocity at the newest of them.</summary>
    /// <remarks>A parabola is fitted by least squares to the newest places, to as many as agree with it: adaptive
    /// windowing of second order (Janabi-Sharifi, Hayward, Chen 2000). The window ends where a cubic would fit better by
    /// more than noise explains, which is sooner noticed than a place outside a band. The derivative is taken at the
    /// newest place, so that nothing lags; what noise alone can explain of the curvature is left out (James and Stein
    /// 1961), so that a tip at rest or in steady motion has no more noise than a straight line gives.</remarks>
    internal sealed class GrowingFit
    {
        public const int Capacity = 64;

        // A cubic of so many deviations of noise ends the window, of one more for each of these speeds by which noise
        // alone moves the velocity: a false alarm costs as much.
        private const double CubicDeviations = 3.0;
        private const double CostMps = 0.01;

        // So many variances of noise are left out of the square of the curvature.
        private const double CurvatureVariances = 4.0;

        // Windows grow by this share, so that many places are fitted only a few times.
        private const int Growth = 8;

        private readonly double[] timesSeconds = new double[Capacity];
        private readonly Double3[] placesMetres = new Double3[Capacity];

        public int Count { get; private set; }

        public bool IsFull => Count == Capacity;

        public double NewestSeconds => timesSeconds[0];

        public double OldestSeconds => timesSeconds[Count - 1];

        public Double3 OldestMetres => placesMetres[Count - 1];

        public void Clear() => Count = 0;

        /// <summary>Adds a place, newest first; not when full.</summary>
        public void Add(double timeSeconds, Double3 placeMetres)
        {
            timesSeconds[Count] = timeSeconds;
            placesMetres[Count] = placeMetres;
            ++Count;
        }

        /// <summary>Velocity at the newest place in m/s; zero with fewer than two places.</summary>
        /// <param name="noiseMetres">Noise of a place on each axis.</param>
        public Double3 EndVelocity(double noiseMetres)
        {
            Double3 velocity = Double3.Zero;
            for (int size = 2; size <= Count && Agrees(size, noiseMetres, out Double3 found);
                size += Math.Max(1, size / Growth))
            {
                velocity = found;
            }
            return velocity;
        }

        /// <summary>Mean over the last seconds, over three places at least, in m/s; zero with fewer than two places.
        /// The difference between the means of the newer and the older half, divided by that of their times (Wald
        /// 1940).</summary>
        public Double3 MeanVelocity(double seconds)
        {
            int size = Math.Min(Count, 3);
            while (size < Count && timesSeconds[0] - timesSeconds[size] <= seconds)
            {
                ++size;
            }
            double duration = 0.0;
            Double3 distance = Double3.Zero;
            for (int newer = 0; newer < size / 2; ++newer)
            {
                int older = size - 1 - newer;
                duration += timesSeconds[newer] - timesSeconds[older];
                distance += placesMetres[newer] - placesMetres[older];
            }
            return duration > 0.0 ? distance / duration : Double3.Zero;
        }

        /// <remarks>The polynomials are orthogonal over the times: t - mean, and two more by Gram and Schmidt. Times and
        /// places count from the newest, so that nothing is lost far from the origin.</remarks>
        private bool Agrees(int size, double noiseMetres, out Double3 velocity)
        {
            double meanSeconds = 0.0;
            for (int index = 0; index < size; ++index)
            {
                meanSeconds += timesSeconds[index] - timesSeconds[0];
            }
            meanSeconds /= size;

            double second = 0.0;
            double third = 0.0;
            double fourth = 0.0;
            Double3 slope = Double3.Zero;
            for (int index = 0; index < size; ++index)
            {
                double linear = timesSeconds[index] - timesSeconds[0] - meanSeconds;
                double square = linear * linear;
                second += square;
                third += square * linear;
                fourth += square * square;
                slope += linear * (placesMetres[index] - placesMetres[0]);
            }
            slope /= second;
            if (size == 2)
            {
                velocity = slope;
                return true;
            }

            double skew = third / second;
            double spread = second / size;
            double norm = 0.0;
            double cross = 0.0;
            Double3 curvature = Double3.Zero;
            for (int index = 0; index < size; ++index)
            {
                double linear = timesSeconds[index] - timesSeconds[0] - meanSeconds;
                double quadratic = (linear - skew) * linear - spread;
                norm += quadratic * quadratic;
                cross += quadratic * linear * linear * linear;
                curvature += quadratic * (placesMetres[index] - placesMetres[0]);
            }
            curvature /= norm;

            double variance = noiseMetres * noiseMetres;
            double explained = Double3.Dot(curvature, curvature) * norm;
            double surplus = explained - CurvatureVariances * variance;
            double share = surplus > 0.0 ? surplus / explained : 0.0;
            double lever = -2.0 * meanSeconds - skew;
            velocity = slope + share * lever * curvature;
            if (size == 3)
            {
                return true;
            }

            double tilt = cross / norm;
            double lean = fourth / second;
            double cubicNorm = 0.0;
            Double3 cubic = Double3.Zero;
            for (int index = 0; index < size; ++index)
            {
                double linear = timesSeconds[index] - timesSeconds[0] - meanSeconds;
                double quadratic = (linear - skew) * linear - spread;
                double value = linear * linear * linear - tilt * quadratic - lean * linear - third / size;
                cubicNorm += value * value;
                cubic += value * (placesMetres[index] - placesMetres[0]);
            }
            double velocityVariance = variance * (1.0 / second + lever * lever / norm);
            double deviations = CubicDeviations + Math.Sqrt(velocityVariance) / CostMps;
            return Double3.Dot(cubic, cubic) <= deviations * deviations * variance * cubicNorm;
        }
    }
}
