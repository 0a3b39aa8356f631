#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
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
}
