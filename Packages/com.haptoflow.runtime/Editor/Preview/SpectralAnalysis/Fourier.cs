#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>Discrete Fourier transform of a fixed length, X[k] = sum x[n] exp(-2 pi i k n / N), by the radix-2
    /// algorithm of Cooley and Tukey (1965). One thread at a time.</summary>
    /// <remarks>Unity transforms only what an AudioSource plays, and a package cannot depend on NuGet.</remarks>
    internal sealed class Fourier
    {
        private readonly double[] cosines;
        private readonly double[] sines;
        private readonly int[] reversed;

        /// <param name="length">A power of two.</param>
        public Fourier(int length)
        {
            if (length < 2 || (length & (length - 1)) != 0)
            {
                throw new ArgumentException($"length {length}; expected a power of two", nameof(length));
            }
            Length = length;
            cosines = new double[length / 2];
            sines = new double[length / 2];
            for (int index = 0; index < length / 2; ++index)
            {
                cosines[index] = Math.Cos(2.0 * Math.PI * index / length);
                sines[index] = -Math.Sin(2.0 * Math.PI * index / length);
            }
            reversed = new int[length];
            for (int index = 1; index < length; ++index)
            {
                reversed[index] = (reversed[index >> 1] >> 1) | ((index & 1) != 0 ? length >> 1 : 0);
            }
        }

        public int Length { get; }

        /// <summary>Transforms in place.</summary>
        public void Transform(double[] real, double[] imaginary)
        {
            for (int index = 0; index < Length; ++index)
            {
                int other = reversed[index];
                if (other > index)
                {
                    (real[index], real[other]) = (real[other], real[index]);
                    (imaginary[index], imaginary[other]) = (imaginary[other], imaginary[index]);
                }
            }
            for (int half = 1; half < Length; half *= 2)
            {
                int stride = Length / (2 * half);
                for (int begin = 0; begin < Length; begin += 2 * half)
                {
                    Butterflies(real, imaginary, begin, half, stride);
                }
            }
        }

        private void Butterflies(double[] real, double[] imaginary, int begin, int half, int stride)
        {
            for (int index = 0; index < half; ++index)
            {
                int upper = begin + index;
                int lower = upper + half;
                double cosine = cosines[index * stride];
                double sine = sines[index * stride];
                double turnedReal = real[lower] * cosine - imaginary[lower] * sine;
                double turnedImaginary = real[lower] * sine + imaginary[lower] * cosine;
                real[lower] = real[upper] - turnedReal;
                imaginary[lower] = imaginary[upper] - turnedImaginary;
                real[upper] += turnedReal;
                imaginary[upper] += turnedImaginary;
            }
        }
    }
}
