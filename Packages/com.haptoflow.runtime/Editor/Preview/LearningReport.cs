#nullable enable
using System;
using System.Globalization;
using System.Linq;
using Newtonsoft.Json;
using Newtonsoft.Json.Serialization;

namespace HaptoFlow.Preview
{
    /// <summary>The library's report on learning: its result in words, and the curves of recording, learnt material and
    /// nearest label. Immutable once read.</summary>
    internal sealed class LearningReport
    {
        private static readonly JsonSerializerSettings Names = new JsonSerializerSettings
        {
            ContractResolver = new DefaultContractResolver { NamingStrategy = new SnakeCaseNamingStrategy() },
            NullValueHandling = NullValueHandling.Ignore,
        };

        /// <summary>The label of the model nearest to the material; empty where the report has none.</summary>
        public string NearestLabel { get; set; } = "";

        /// <summary>Angle from the recording's first axis to the material's; 0 if the report has none.</summary>
        public double TurnDegrees { get; set; }

        public double? SpectralDistanceDb { get; set; }
        public double? LevelErrorDb { get; set; }

        public double? SlidingSeconds { get; set; }

        public double? Seconds { get; set; }

        public Noise SensorNoise { get; set; } = new Noise();
        public string[] Warnings { get; set; } = Array.Empty<string>();

        /// <summary>The recording that would improve the material most, as half a sentence ("record slower strokes");
        /// empty if no further recording would help much.</summary>
        public string RecordNext { get; set; } = "";

        public OverFrequency Spectra { get; set; } = new OverFrequency();

        public OverSpeed Levels { get; set; } = new OverSpeed();

        /// <summary>One for each family of ribs that was found: none, one or two.</summary>
        public WaveVector[] WaveVectors { get; set; } = Array.Empty<WaveVector>();

        public bool HasCurves => Spectra.Speeds.Length > 0 && Levels.Forces.Length > 0;

        /// <summary>The result in one or two sentences; missing values are left out.</summary>
        public string Sentences
        {
            get
            {
                string[] parts = new[]
                {
                    NearestLabel.Length > 0 ? "nearest label: " + NearestLabel : "",
                    Figure("spectra within {0:0.0} dB", SpectralDistanceDb),
                    Figure("levels within {0:0.0} dB", LevelErrorDb),
                    Figure("{0:0.0} s of sliding", SlidingSeconds),
                    SensorNoise.Mps2 > 0.0
                        ? Figure("{0:0.000} m/s^2 of the sensor's noise removed", SensorNoise.Mps2) : "",
                    Math.Abs(TurnDegrees) >= 0.5
                        ? Figure("the first axis is perpendicular to the ribs, {0:0} degrees from the recording's",
                            TurnDegrees) : "",
                    Figure("learnt in {0:0.0} s", Seconds),
                }.Where(part => part.Length > 0).ToArray();
                return "Learnt." + Sentence(string.Join("; ", parts)) +
                    Sentence(RecordNext.Length > 0 ? "to gain most, " + RecordNext : "") +
                    string.Concat(Warnings.Select(Sentence));
            }
        }

        /// <returns>Null for a text that is no report.</returns>
        public static LearningReport? Read(string json)
        {
            try
            {
                return JsonConvert.DeserializeObject<LearningReport>(json, Names);
            }
            catch (JsonException)
            {
                return null;
            }
        }

        private static string Figure(string format, double? number) =>
            number.HasValue ? string.Format(CultureInfo.InvariantCulture, format, number) : "";

        private static string Sentence(string words) => words.Length == 0
            ? ""
            : $" {char.ToUpperInvariant(words[0])}{words.Substring(1).TrimEnd('.')}.";

        internal sealed class Noise
        {
            public double Mps2 { get; set; }
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
