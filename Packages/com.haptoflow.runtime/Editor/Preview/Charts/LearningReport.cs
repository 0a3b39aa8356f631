#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
    /// <summary>The library's report on learning. Immutable.</summary>
    internal sealed class LearningReport
    {
        private LearningReport(JsonValue json)
        {
            NearestLabel = json.Find("nearest_label")?.Text ?? "";
            TurnDegrees = json.Find("turn_degrees")?.Number ?? 0.0;
            Sentences = SentencesOf(json);
            Curves = LearningCurves.Of(json);
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
                return new LearningReport(JsonValue.Parse(json.Trim()));
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
    /// Immutable.</summary>
    internal sealed class LearningCurves
    {
        private LearningCurves(JsonValue report)
        {
            JsonValue spectra = report["spectra"];
            FrequenciesHz = Numbers(spectra["frequencies_hz"]);
            Speeds = spectra["speeds"].AsArray().Select(each => new AtSpeed(each)).ToArray();
            JsonValue levels = report["levels"];
            LawSpeedsMps = Numbers(levels["speeds_mps"]);
            Forces = levels["forces"].AsArray().Select(each => new AtForce(each)).ToArray();
            RibsMillimetres = report["wave_vectors"].AsArray().Select(Millimetres).ToArray();
            NearestLabel = report["nearest_label"].AsText();
            RecordNext = report.Find("record_next")?.Text ?? "";
        }

        public IReadOnlyList<double> FrequenciesHz { get; }

        /// <summary>The ranges of speed, slowest first.</summary>
        public IReadOnlyList<AtSpeed> Speeds { get; }

        /// <summary>Speeds of the levels of <see cref="Forces"/>.</summary>
        public IReadOnlyList<double> LawSpeedsMps { get; }

        /// <summary>The ranges of force, lightest first.</summary>
        public IReadOnlyList<AtForce> Forces { get; }

        /// <summary>Distance of the ribs that were found: none, one or two.</summary>
        public IReadOnlyList<double> RibsMillimetres { get; }

        public string NearestLabel { get; }

        /// <summary>The recording that would improve the material most, as half a sentence ("record slower strokes");
        /// empty if no further recording would help much.</summary>
        public string RecordNext { get; }

        /// <returns>Null where the report has no curves.</returns>
        public static LearningCurves? Of(JsonValue report)
        {
            try
            {
                var curves = new LearningCurves(report);
                return curves.Speeds.Count > 0 && curves.Forces.Count > 0 ? curves : null;
            }
            catch (FormatException)
            {
                return null;
            }
        }

        private static double[] Numbers(JsonValue array) =>
            array.AsArray().Select(each => each.AsNumber()).ToArray();

        private static double Millimetres(JsonValue waveVector)
        {
            double x = waveVector["x_cycles_per_mm"].AsNumber();
            double y = waveVector["y_cycles_per_mm"].AsNumber();
            return 1.0 / Math.Sqrt(x * x + y * y);
        }

        /// <summary>Figures of the frames of one range of speed, or of speed and force.</summary>
        internal sealed class Figures
        {
            public Figures(JsonValue json)
            {
                Frames = json["frames"].AsInteger();
                RmsMps2 = json["rms_mps2"].AsNumber();
                Kurtosis = json["kurtosis"].Number;
                RibsDecibels = json["ribs_db"].AsArray().Select(each => each.Number).ToArray();
                Decibels = json.Find("decibels") is { } curve ? Numbers(curve) : Array.Empty<double>();
            }

            /// <summary>A frame lasts 128 ms and begins 64 ms after the one before.</summary>
            public int Frames { get; }

            public double RmsMps2 { get; }

            /// <summary>3 for Gaussian noise, more with rare events; null without frames.</summary>
            public double? Kurtosis { get; }

            /// <summary>Power of each rib's partials over that of the whole wave; null where it is not known.</summary>
            public IReadOnlyList<double?> RibsDecibels { get; }

            /// <summary>Power density at <see cref="FrequenciesHz"/>, dB re 1 (m/s^2)^2/Hz; empty for a range of force,
            /// and without frames.</summary>
            public IReadOnlyList<double> Decibels { get; }
        }

        /// <summary>One range of speed.</summary>
        internal sealed class AtSpeed
        {
            public AtSpeed(JsonValue json)
            {
                SpeedMps = json["speed_mps"].AsNumber();
                Seconds = json.Find("seconds")?.Number ?? 0.0;
                Recorded = new Figures(json["recorded"]);
                Learnt = new Figures(json["learnt"]);
                NearestLabel = new Figures(json["nearest_label"]);
                Sides = new[] { NearestLabel, Recorded, Learnt };
            }

            public double SpeedMps { get; }

            /// <summary>Duration of the sliding that was recorded; 0 for a range of force.</summary>
            public double Seconds { get; }

            public Figures Recorded { get; }

            public Figures Learnt { get; }

            public Figures NearestLabel { get; }

            /// <summary>Nearest label, recorded, learnt: in the order in which they are drawn, so that the learnt curve lies
            /// on top.</summary>
            public IReadOnlyList<Figures> Sides { get; }
        }

        /// <summary>One range of force.</summary>
        internal sealed class AtForce
        {
            public AtForce(JsonValue json)
            {
                ForceNewtons = json["force_newtons"].AsNumber();
                double[] ends = Numbers(json["recorded_speed_mps"]);
                RecordedMps = (ends[0], ends[1]);
                LearntMps2 = Numbers(json["learnt_mps2"]);
                NearestLabelMps2 = Numbers(json["nearest_label_mps2"]);
                Speeds = json["speeds"].AsArray().Select(each => new AtSpeed(each)).ToArray();
            }

            public double ForceNewtons { get; }

            /// <summary>Beyond these speeds the material is extrapolated.</summary>
            public (double Low, double High) RecordedMps { get; }

            /// <summary>Levels at <see cref="LawSpeedsMps"/>.</summary>
            public IReadOnlyList<double> LearntMps2 { get; }

            /// <summary>Levels at <see cref="LawSpeedsMps"/>.</summary>
            public IReadOnlyList<double> NearestLabelMps2 { get; }

            public IReadOnlyList<AtSpeed> Speeds { get; }
        }
    }
}
