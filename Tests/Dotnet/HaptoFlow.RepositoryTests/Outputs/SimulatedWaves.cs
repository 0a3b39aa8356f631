#nullable enable
using System;
using HaptoFlow.Outputs;

namespace HaptoFlow.RepositoryTests.Outputs
{
    /// <summary>A wave that can be evaluated at every position.</summary>
    internal sealed class SimulatedWave : IWaveSource
    {
        private readonly Func<double, double> wave;

        /// <param name="wave">Maps a time in seconds to a sample.</param>
        public SimulatedWave(Func<double, double> wave) => this.wave = wave;

        public static SimulatedWave Sine(double hertz, double amplitude = 0.3) =>
            new SimulatedWave(seconds => amplitude * Math.Sin(2.0 * Math.PI * hertz * seconds));

        /// <summary>Noise between two frequencies as a sum of sines, reproducible at every position.</summary>
        public static SimulatedWave Noise(double lowHz, double highHz, double rms)
        {
            const int partials = 40;
            var random = new Random(5);
            var phases = new double[partials];
            for (int index = 0; index < partials; ++index)
            {
                phases[index] = 2.0 * Math.PI * random.NextDouble();
            }
            double each = rms * Math.Sqrt(2.0 / partials);
            return new SimulatedWave(seconds =>
            {
                double sum = 0.0;
                for (int index = 0; index < partials; ++index)
                {
                    double hertz = lowHz + (highHz - lowHz) * (index + 0.37) / partials;
                    sum += each * Math.Sin(2.0 * Math.PI * hertz * seconds + phases[index]);
                }
                return sum;
            });
        }

        public long Position { get; private set; }

        public bool IsSilent { get; set; }

        public bool IsStopped { get; set; }

        public void Render(Span<float> samples)
        {
            for (int index = 0; index < samples.Length; ++index, ++Position)
            {
                samples[index] = IsSilent ? 0f : (float)wave(Position / WaveHistory.RateHz);
            }
        }
    }
}
