#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>Combines three axes of vibration into one by DFT321 (Landin et al. 2010), as learning does: each frame
    /// has the energy of all axes and the phase of their sum. Square-root Hann windows for analysis and synthesis,
    /// overlapping by half.</summary>
    internal static class AxisCombination
    {
        private const double FrameSeconds = 0.035;

        /// <param name="interleaved">x, y, z of each sample.</param>
        public static float[] Combined(ReadOnlySpan<float> interleaved, double rateHz)
        {
            int count = interleaved.Length / 3;
            int length = 64;
            while (length < FrameSeconds * rateHz)
            {
                length *= 2;
            }
            int hop = length / 2;
            var fourier = new Fourier(length);
            var real = new double[3][];
            var imaginary = new double[3][];
            for (int axis = 0; axis < 3; ++axis)
            {
                real[axis] = new double[length];
                imaginary[axis] = new double[length];
            }
            var result = new float[count];
            for (int begin = -hop; begin < count; begin += hop)
            {
                for (int axis = 0; axis < 3; ++axis)
                {
                    Load(interleaved, axis, begin, real[axis], imaginary[axis]);
                    fourier.Transform(real[axis], imaginary[axis]);
                }
                Combine(real, imaginary);
                // The inverse transform is the forward transform of the conjugate.
                fourier.Transform(real[0], imaginary[0]);
                for (int index = 0; index < length; ++index)
                {
                    int place = begin + index;
                    if (place >= 0 && place < count)
                    {
                        result[place] += (float)(Window(index, length) * real[0][index] / length);
                    }
                }
            }
            return result;
        }

        private static void Load(
            ReadOnlySpan<float> interleaved, int axis, int begin, double[] real, double[] imaginary)
        {
            for (int index = 0; index < real.Length; ++index)
            {
                int place = 3 * (begin + index) + axis;
                bool isInside = begin + index >= 0 && place < interleaved.Length;
                real[index] = isInside ? Window(index, real.Length) * interleaved[place] : 0.0;
                imaginary[index] = 0.0;
            }
        }

        /// <summary>Writes the conjugate of the combined spectrum into the first axis.</summary>
        private static void Combine(double[][] real, double[][] imaginary)
        {
            for (int bin = 0; bin < real[0].Length; ++bin)
            {
                double energy = 0.0;
                double sumReal = 0.0;
                double sumImaginary = 0.0;
                for (int axis = 0; axis < 3; ++axis)
                {
                    energy += real[axis][bin] * real[axis][bin] + imaginary[axis][bin] * imaginary[axis][bin];
                    sumReal += real[axis][bin];
                    sumImaginary += imaginary[axis][bin];
                }
                double size = Math.Sqrt(sumReal * sumReal + sumImaginary * sumImaginary);
                double scale = size > 1e-12 ? Math.Sqrt(energy) / size : 0.0;
                real[0][bin] = scale * sumReal;
                imaginary[0][bin] = -scale * sumImaginary;
            }
        }

        private static double Window(int index, int length) => Math.Sin(Math.PI * index / length);
    }
}
