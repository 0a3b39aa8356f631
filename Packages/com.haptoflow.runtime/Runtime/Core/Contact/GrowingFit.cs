#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
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

        /// <summary>Fits the newest places; false if a cubic fits them better by more than noise explains.</summary>
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
