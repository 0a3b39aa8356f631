#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
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

        /// <param name="report">The library's report as JSON.</param>
        /// <returns>Null where the report has no curves.</returns>
        public static LearningCurves? Read(string report)
        {
            try
            {
                var curves = new LearningCurves(JsonValue.Parse(report.Trim()));
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
