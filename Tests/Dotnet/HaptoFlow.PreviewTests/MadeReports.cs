using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Reports of learning as the library writes them, with curves of a made surface.</summary>
    internal static class MadeReports
    {
        private static readonly double[] Speeds = { 0.02, 0.034, 0.058, 0.099, 0.17, 0.25 };

        /// <param name="speeds">Number of ranges of speed, 1 to 6.</param>
        /// <param name="forces">Number of ranges of force.</param>
        /// <param name="ribs">Number of wave vectors, 0 to 2.</param>
        public static string Of(int speeds, int forces, int ribs,
            string recordNext = "record faster strokes, up to 300 mm/s: above 250 mm/s the material is a guess")
        {
            IReadOnlyList<double> frequencies = Enumerable.Range(0, 35).Select(step => 15.625 * Math.Pow(2.0, step / 6.0))
                .ToArray();
            IReadOnlyList<double> law = Enumerable.Range(0, 25).Select(step => 0.005 * Math.Pow(200.0, step / 24.0))
                .ToArray();
            return "{\"nearest_label\": \"metal mesh\", \"record_next\": \"" + recordNext + "\", \"wave_vectors\": [" +
                string.Join(", ", Enumerable.Repeat("{\"x_cycles_per_mm\": 0.9, \"y_cycles_per_mm\": 0.0}", ribs)) +
                "], \"spectra\": {\"frequencies_hz\": " + Array(frequencies) + ", \"speeds\": [" +
                string.Join(", ", Speeds.Take(speeds).Select(speed => AtSpeed(speed, ribs, frequencies))) +
                "]}, \"levels\": {\"speeds_mps\": " + Array(law) + ", \"forces\": [" +
                string.Join(", ", Enumerable.Range(1, forces).Select(force => AtForce(0.5 * force, speeds, ribs, law))) +
                "]}}";
        }

        private static string AtForce(double newtons, int speeds, int ribs, IReadOnlyList<double> law) =>
            "{\"force_newtons\": " + Text(newtons) + ", \"recorded_speed_mps\": " +
            Array(new[] { Speeds[0], Speeds[speeds - 1] }) + ", \"learnt_mps2\": " +
            Array(law.Select(speed => 15.0 * newtons * speed)) + ", \"nearest_label_mps2\": " +
            Array(law.Select(speed => 8.0 * newtons * Math.Sqrt(speed))) + ", \"speeds\": [" +
            string.Join(", ", Speeds.Take(speeds).Select(speed => AtSpeed(speed, ribs, null, newtons))) + "]}";

        private static string AtSpeed(
            double speed, int ribs, IReadOnlyList<double>? frequencies, double gain = 1.0) =>
            "{\"speed_mps\": " + Text(speed) + ", \"seconds\": 1.7, \"recorded\": " + Figures(gain * speed, 3.4, ribs, frequencies) +
            ", \"learnt\": " + Figures(1.1 * gain * speed, 3.1, ribs, frequencies) + ", \"nearest_label\": " +
            Figures(2.0 * gain * speed, 5.0, ribs, frequencies) + "}";

        private static string Figures(double speed, double kurtosis, int ribs, IReadOnlyList<double>? frequencies)
        {
            string curve = frequencies == null ? "" : ", \"decibels\": " + Array(frequencies.Select(hertz =>
                20.0 * Math.Log10(speed) - 3.0 * Math.Abs(Math.Log(hertz / 180.0, 2.0))));
            return "{\"frames\": 27, \"rms_mps2\": " + Text(15.0 * speed) + ", \"kurtosis\": " + Text(kurtosis) +
                ", \"ribs_db\": [" + (ribs > 0 ? "-6.1" : "null") + ", " + (ribs > 1 ? "-14.0" : "null") + "]" + curve + "}";
        }

        private static string Array(IEnumerable<double> values) => "[" + string.Join(", ", values.Select(Text)) + "]";

        private static string Text(double value) => value.ToString("R", CultureInfo.InvariantCulture);
    }
}
