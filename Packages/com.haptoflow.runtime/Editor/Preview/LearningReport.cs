#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using HaptoFlow.Model;
using Newtonsoft.Json;
using Newtonsoft.Json.Serialization;

namespace HaptoFlow.Preview
{
    /// <summary>The library's report on learning. Immutable.</summary>
    internal sealed class LearningReport
    {
        private LearningReport(string text)
        {
            JsonValue json = JsonValue.Parse(text);
            NearestLabel = json.Find("nearest_label")?.Text ?? "";
            TurnDegrees = json.Find("turn_degrees")?.Number ?? 0.0;
            Sentences = SentencesOf(json);
            Curves = LearningCurves.Of(text);
        }

        /// <summary>The label of the model nearest to the material; empty where the report has none.</summary>
        public string NearestLabel { get; }

        /// <summary>Angle from the recording's first axis to the material's; 0 if the report has none.</summary>
        public double TurnDegrees { get; }

        /// <summary>The result in one or two sentences; missing values are left out.</summary>
        public string Sentences { get; }

        /// <summary>Null where the report has no curves.</summary>
        public LearningCurves? Curves { get; }

        /// <returns>Null for a text that is no report.</returns>
        public static LearningReport? Read(string json)
        {
            try
            {
                return new LearningReport(json.Trim());
            }
            catch (FormatException)
            {
                return null;
            }
        }

        private static string SentencesOf(JsonValue report)
        {
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

    /// <summary>What the library's report on learning says of recording, learnt material and nearest label, to be drawn.
    /// Immutable once read.</summary>
    internal sealed class LearningCurves
    {
        private static readonly JsonSerializerSettings Names = new JsonSerializerSettings
        {
            ContractResolver = new DefaultContractResolver { NamingStrategy = new SnakeCaseNamingStrategy() },
        };

        public OverFrequency Spectra { get; set; } = new OverFrequency();

        public OverSpeed Levels { get; set; } = new OverSpeed();

        /// <summary>One for each family of ribs that was found: none, one or two.</summary>
        public WaveVector[] WaveVectors { get; set; } = Array.Empty<WaveVector>();

        public string NearestLabel { get; set; } = "";

        /// <summary>The recording that would improve the material most, as half a sentence ("record slower strokes");
        /// empty if no further recording would help much.</summary>
        public string RecordNext { get; set; } = "";

        /// <returns>Null where the report has no curves.</returns>
        public static LearningCurves? Of(string report)
        {
            try
            {
                LearningCurves? curves = JsonConvert.DeserializeObject<LearningCurves>(report, Names);
                return curves?.Spectra.Speeds.Length > 0 && curves.Levels.Forces.Length > 0 ? curves : null;
            }
            catch (JsonException)
            {
                return null;
            }
        }

        internal sealed class OverFrequency
        {
            public double[] FrequenciesHz { get; set; } = Array.Empty<double>();

            /// <summary>The ranges of speed, slowest first.</summary>
            public AtSpeed[] Speeds { get; set; } = Array.Empty<AtSpeed>();
        }

        internal sealed class OverSpeed
        {
            /// <summary>Speeds of the levels of <see cref="Forces"/>.</summary>
            public double[] SpeedsMps { get; set; } = Array.Empty<double>();

            /// <summary>The ranges of force, lightest first.</summary>
            public AtForce[] Forces { get; set; } = Array.Empty<AtForce>();
        }

        internal sealed class WaveVector
        {
            public double XCyclesPerMm { get; set; }
            public double YCyclesPerMm { get; set; }

            /// <summary>Distance of the ribs.</summary>
            public double Millimetres => 1.0 / Math.Sqrt(XCyclesPerMm * XCyclesPerMm + YCyclesPerMm * YCyclesPerMm);
        }

        /// <summary>Figures of the frames of one range of speed, or of speed and force. A frame lasts 128 ms and begins
        /// 64 ms after the one before.</summary>
        internal sealed class Figures
        {
            public int Frames { get; set; }
            public double RmsMps2 { get; set; }

            /// <summary>3 for Gaussian noise, more with rare events; null without frames.</summary>
            public double? Kurtosis { get; set; }

            /// <summary>Power of each rib's partials over that of the whole wave, dB; null where it is not known.</summary>
            public double?[] RibsDb { get; set; } = Array.Empty<double?>();

            /// <summary>Power density at the frequencies of <see cref="Spectra"/>, dB re 1 (m/s^2)^2/Hz; empty for a range
            /// of force, and without frames.</summary>
            public double[] Decibels { get; set; } = Array.Empty<double>();
        }

        /// <summary>One range of speed.</summary>
        internal sealed class AtSpeed
        {
            public double SpeedMps { get; set; }

            /// <summary>Duration of the sliding that was recorded; 0 for a range of force.</summary>
            public double Seconds { get; set; }

            public Figures Recorded { get; set; } = new Figures();
            public Figures Learnt { get; set; } = new Figures();
            public Figures NearestLabel { get; set; } = new Figures();

            /// <summary>In the order in which they are drawn, so that the learnt curve lies on top.</summary>
            public Figures[] Sides => new[] { NearestLabel, Recorded, Learnt };
        }

        /// <summary>One range of force.</summary>
        internal sealed class AtForce
        {
            public double ForceNewtons { get; set; }

            /// <summary>The lowest and the highest; beyond them the material is extrapolated.</summary>
            public double[] RecordedSpeedMps { get; set; } = new double[2];

            /// <summary>Levels at <see cref="OverSpeed.SpeedsMps"/>.</summary>
            public double[] LearntMps2 { get; set; } = Array.Empty<double>();

            /// <summary>Levels at <see cref="OverSpeed.SpeedsMps"/>.</summary>
            public double[] NearestLabelMps2 { get; set; } = Array.Empty<double>();

            public AtSpeed[] Speeds { get; set; } = Array.Empty<AtSpeed>();
        }
    }
}
