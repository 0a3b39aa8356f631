#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Recordings
{
    /// <summary>Rejects numbers that indicate a wrong unit in a column's name, and signals of a dead sensor.</summary>
    internal static class RecordingChecks
    {
        private const double MinimumSpeedMps = 0.0005;
        private const double MaximumRmsMps2 = 40.0 * ColumnForms.GravityMps2;

        private static readonly Dictionary<string, string> OtherUnit = new Dictionary<string, string>
        {
            ["velocity_x_mps"] = "m/s (a thousandth of mm/s)",
            ["speed_mps"] = "m/s; name the column speed_mmps where it is in mm/s",
            ["speed_mmps"] = "mm/s; name the column speed_mps where it is in m/s",
            ["position_x_mm"] = "millimetres; name the columns position_x_m, position_y_m where they are in metres",
            ["position_x_m"] = "metres; name the columns position_x_mm, position_y_mm where they are in millimetres",
        };

        /// <exception cref="HaptoFlowException">Names the file, the column and the remedy.</exception>
        public static void CheckAcceleration(string file, Series acceleration)
        {
            double[] means = acceleration.Values.Select(axis => axis.Average()).ToArray();
            double rest = Math.Sqrt(means.Sum(mean => mean * mean));
            double rms = Math.Sqrt(acceleration.Values.Select((axis, index) =>
                axis.Average(value => (value - means[index]) * (value - means[index]))).Sum());
            string column = acceleration.Columns[0];
            if (rms.Equals(0.0))
            {
                throw RecordingError.Of(file, $"{column} stays the same", "a signal that changes: check the sensor");
            }
            bool isG = column.EndsWith("_g", StringComparison.Ordinal);
            double restInG = rest / ColumnForms.GravityMps2;
            if (isG && restInG > 6.0 && restInG < 14.0)
            {
                throw RecordingError.Of(file, Inv($"{column} rests at {restInG:0.0}, which looks like m/s^2"),
                    "g (1 at rest); name the column with _mps2 where it is in m/s^2");
            }
            if (!isG && acceleration.Columns.Count == 3 && rest > 0.9 && rest < 1.1)
            {
                throw RecordingError.Of(file, Inv($"{column} rests at {rest:0.00}, which looks like g"),
                    "m/s^2 (9.8 at rest); name the columns with _g where they are in g");
            }
            if (rms > MaximumRmsMps2)
            {
                throw RecordingError.Of(file, Inv($"{column} has an RMS of {rms:0} m/s^2"),
                    Inv($"at most {MaximumRmsMps2:0}: check the unit, or full_scale_mps2 of a WAV file"));
            }
        }

        /// <exception cref="HaptoFlowException">Names the file, the column and the remedy.</exception>
        public static void CheckSpeeds(string file, Series motion, IEnumerable<double> speedsMps)
        {
            double[] sorted = speedsMps.OrderBy(speed => speed).ToArray();
            double[] moving = sorted.Where(speed => speed > 0.2 * sorted[(int)(0.95 * (sorted.Length - 1))]).ToArray();
            if (moving.Length == 0)
            {
                return;
            }
            double median = moving[moving.Length / 2];
            if (!(median > MinimumSpeedMps && median < RecordingSidecar.MaximumSpeedMps))
            {
                throw RecordingError.Of(file, Inv($"{motion.Columns[0]} gives a speed of {median:0.###} m/s"),
                    OtherUnit[motion.Columns[0]]);
            }
        }

        /// <exception cref="HaptoFlowException">Names the file, the column and the remedy.</exception>
        public static void CheckForce(string file, Series force)
        {
            double[] sorted = force.Values[0].Select(Math.Abs).OrderBy(value => value).ToArray();
            double median = sorted[sorted.Length / 2];
            if (median > RecordingSidecar.MaximumForceNewtons)
            {
                throw RecordingError.Of(file, Inv($"{force.Columns[0]} is {median:0.###} N"),
                    "newtons; name the column force_millinewtons where it is in mN");
            }
        }

        private static string Inv(FormattableString text) => FormattableString.Invariant(text);
    }
}
