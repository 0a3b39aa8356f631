#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Recordings
{
    /// <summary>Readings of one quantity at rising times.</summary>
    internal sealed class Series
    {
        /// <param name="values">One array per column, in SI units.</param>
        public Series(double[] seconds, double[][] values, IReadOnlyList<string> columns)
        {
            Seconds = seconds;
            Values = values;
            Columns = columns;
        }

        public double[] Seconds { get; }

        public double[][] Values { get; }

        /// <summary>Names of the columns.</summary>
        public IReadOnlyList<string> Columns { get; }

        public int Count => Seconds.Length;

        public double StepSeconds
        {
            get
            {
                double[] steps = Enumerable.Range(1, Count - 1).Select(row => Seconds[row] - Seconds[row - 1])
                    .OrderBy(step => step).ToArray();
                return steps[steps.Length / 2];
            }
        }

        /// <summary>A column at equidistant times, interpolated linearly and held constant beyond the ends.</summary>
        public double[] At(int column, double firstSeconds, double stepSeconds, int count)
        {
            var result = new double[count];
            double[] values = Values[column];
            int row = 0;
            for (int index = 0; index < count; ++index)
            {
                double time = firstSeconds + index * stepSeconds;
                while (row < Count - 2 && Seconds[row + 1] <= time)
                {
                    ++row;
                }
                double share = (time - Seconds[row]) / (Seconds[row + 1] - Seconds[row]);
                share = Math.Max(0.0, Math.Min(1.0, share));
                result[index] = values[row] + share * (values[row + 1] - values[row]);
            }
            return result;
        }
    }
}
