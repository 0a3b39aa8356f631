#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using HaptoFlow.Model;

namespace HaptoFlow.Editor
{
    /// <summary>Describes the result of learning in one or two sentences.</summary>
    internal static class LearningReportText
    {
        /// <param name="json">The library's report; missing values are left out.</param>
        public static string Of(string json)
        {
            JsonValue? report = Parsed(json);
            if (report == null)
            {
                return "";
            }
            var parts = new List<string>();
            if (report.Find("nearest_label")?.Text is { } nearest)
            {
                parts.Add("nearest label: " + nearest);
            }
            Add(parts, report, "spectral_distance_db", "spectra within {0:0.0} dB");
            Add(parts, report, "level_error_db", "levels within {0:0.0} dB");
            Add(parts, report, "sliding_seconds", "{0:0.0} s of sliding");
            if (report.Find("sensor_noise")?.Find("mps2")?.Number is { } noise && noise > 0.0)
            {
                parts.Add(string.Format(CultureInfo.InvariantCulture,
                    "{0:0.000} m/s^2 of the sensor's noise removed", noise));
            }
            if (report.Find("turn_degrees")?.Number is { } turn && Math.Abs(turn) >= 0.5)
            {
                parts.Add(string.Format(CultureInfo.InvariantCulture,
                    "the first axis is perpendicular to the ribs, {0:0} degrees from the recording's", turn));
            }
            Add(parts, report, "seconds", "learnt in {0:0.0} s");
            string text = parts.Count > 0 ? "Learnt. " + Capital(string.Join("; ", parts)) + "." : "Learnt.";
            if (report.Find("record_next")?.Text is { Length: > 0 } next)
            {
                text += " To gain most, " + next.TrimEnd('.') + ".";
            }
            if (report.Find("warnings")?.Elements is { } warnings)
            {
                foreach (JsonValue warning in warnings)
                {
                    text += warning.Text is { } words ? " " + Capital(words.TrimEnd('.')) + "." : "";
                }
            }
            return text;
        }

        /// <summary>Angle from the recording's first axis to the material's; 0 if the report has none.</summary>
        public static double TurnDegrees(string json) =>
            Parsed(json)?.Find("turn_degrees")?.Number ?? 0.0;

        private static JsonValue? Parsed(string json)
        {
            try
            {
                return JsonValue.Parse(json.Trim());
            }
            catch (FormatException)
            {
                return null;
            }
        }

        private static void Add(List<string> parts, JsonValue report, string key, string format)
        {
            if (report.Find(key)?.Number is { } number)
            {
                parts.Add(string.Format(CultureInfo.InvariantCulture, format, number));
            }
        }

        private static string Capital(string words) =>
            words.Length > 0 ? char.ToUpperInvariant(words[0]) + words.Substring(1) : words;
    }
}
