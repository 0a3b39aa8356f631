#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;

namespace HaptoFlow.Preview
{
    /// <summary>Numbers of chart axes.</summary>
    internal static class AxisNumbers
    {
        /// <summary>Multiples of 1, 2 or 5 times a power of ten from <paramref name="low"/> to <paramref name="high"/>.
        /// </summary>
        /// <param name="maximum">Number of intervals.</param>
        public static IReadOnlyList<double> Ticks(double low, double high, int maximum)
        {
            double step = Step(high - low, maximum);
            var ticks = new List<double>();
            for (double tick = Math.Ceiling(low / step - 1e-9) * step; tick <= high + 1e-9 * step; tick += step)
            {
                ticks.Add(Math.Abs(tick) < 1e-9 * step ? 0.0 : tick);
            }
            return ticks;
        }

        /// <summary>The smallest 1, 2 or 5 times a power of ten that is not below a value; 1 if the value is not
        /// positive.</summary>
        public static double RoundUp(double value)
        {
            if (!(value > 0.0))
            {
                return 1.0;
            }
            double power = Math.Pow(10.0, Math.Floor(Math.Log10(value)));
            double share = value / power;
            return power * (share <= 1.0 + 1e-9 ? 1.0 : share <= 2.0 + 1e-9 ? 2.0 : share <= 5.0 + 1e-9 ? 5.0 : 10.0);
        }

        /// <summary>A number for display in every locale, with a typographic minus.</summary>
        /// <param name="digits">Maximum number of digits after the point.</param>
        /// <param name="signed">True for a plus before positive numbers.</param>
        public static string Text(double value, int digits, bool signed = false)
        {
            string zeros = digits > 0 ? "0." + new string('#', digits) : "0";
            return Minus(value, zeros, signed);
        }

        /// <summary>As <see cref="Text"/>, with trailing zeros.</summary>
        public static string Fixed(double value, int digits, bool signed = false) =>
            Minus(value, digits > 0 ? "0." + new string('0', digits) : "0", signed);

        private static double Step(double span, int maximum) => RoundUp(span / Math.Max(1, maximum));

        private static string Minus(double value, string format, bool signed)
        {
            string size = Math.Abs(value).ToString(format, CultureInfo.InvariantCulture);
            bool zero = size.Trim('0', '.').Length == 0;
            return (value < 0.0 && !zero ? "\u2212" : signed && !zero ? "+" : "") + size;
        }
    }
}
