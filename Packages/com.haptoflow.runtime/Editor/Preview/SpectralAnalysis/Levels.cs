#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>Arithmetic of decibels.</summary>
    internal static class Levels
    {
        /// <summary>10 log10 of a power; minus infinity for none.</summary>
        public static double Decibels(double power) =>
            power > 0.0 ? 10.0 * Math.Log10(power) : double.NegativeInfinity;

        /// <summary>The next multiple of ten that is at least 3 dB above: the top of a picture.</summary>
        public static double Top(double highestDecibels) => double.IsInfinity(highestDecibels)
            ? 0.0
            : 10.0 * Math.Ceiling((highestDecibels + 3.0) / 10.0);
    }
}
