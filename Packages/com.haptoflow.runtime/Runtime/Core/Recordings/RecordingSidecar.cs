#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;
using HaptoFlow.Model;

namespace HaptoFlow.Recordings
{
    /// <summary>The metadata beside a recording: NAME.json, and recordings.json with defaults for its folder. Values
    /// are null or empty where the files leave them to the recording's columns.</summary>
    internal sealed class RecordingSidecar
    {
        public const string DefaultsFile = "recordings.json";
        public const double MinimumRateHz = 1000.0;
        public const double MaximumRateHz = 192000.0;
        public const double MaximumSpeedMps = 10.0;
        public const double MaximumForceNewtons = 100.0;

        private static readonly string[] Keys =
        {
            "label", "full_scale_mps2", "speed_mps", "velocity_mps", "force_newtons", "motion", "rate_hz", "licence",
            "source",
        };

        private readonly Dictionary<string, (JsonValue Value, string File)> values =
            new Dictionary<string, (JsonValue, string)>(StringComparer.Ordinal);

        private RecordingSidecar(string file) => File = file;

        /// <summary>Name of the sidecar, whether or not it exists.</summary>
        public string File { get; }

        public string Label => Text("label");

        public string Licence => Text("licence");

        public string Source => Text("source");

        /// <summary>Empty for none.</summary>
        public string Motion => Text("motion");

        public double? FullScaleMps2 => Number("full_scale_mps2", 0.01, 1e5, "m/s^2 at +-1, 0.01 to 100000");

        public double? ForceNewtons =>
            Number("force_newtons", 0.0, MaximumForceNewtons, "newtons, 0 to 100 (a thousandth of mN)");

        public double? RateHz => Number("rate_hz", MinimumRateHz, MaximumRateHz, "samples a second, 1000 to 192000");

        /// <summary>The velocity; a speed is taken along the first axis.</summary>
        public (double X, double Y)? VelocityMps
        {
            get
            {
                double? speed = Number("speed_mps", 0.0, MaximumSpeedMps,
                    "metres a second, 0 to 10 (a thousandth of mm/s)");
                return speed.HasValue ? (speed.Value, 0.0) : PairOf("velocity_mps");
            }
        }

        /// <param name="file">The recording's sidecar, for messages.</param>
        /// <param name="own">Its contents; null where it does not exist.</param>
        /// <param name="defaults">The folder's recordings.json; null where there is none.</param>
        /// <exception cref="HaptoFlowException">Names the file, the key, what was found and what is expected.
        /// </exception>
        public static RecordingSidecar Read(string file, byte[]? own, byte[]? defaults)
        {
            var sidecar = new RecordingSidecar(file);
            sidecar.Take(DefaultsFile, defaults);
            sidecar.Take(file, own);
            sidecar.CheckAll();
            return sidecar;
        }

        private void Take(string file, byte[]? bytes)
        {
            if (bytes == null)
            {
                return;
            }
            IReadOnlyDictionary<string, JsonValue> document = DocumentOf(file, bytes);
            string? unknown = document.Keys.FirstOrDefault(key => !Keys.Contains(key));
            if (unknown != null)
            {
                throw RecordingError.Of(file, $"unknown key '{unknown}'", "keys of " + string.Join(", ", Keys));
            }
            bool hasSpeed = document.ContainsKey("speed_mps");
            bool hasVelocity = document.ContainsKey("velocity_mps");
            if (hasSpeed && hasVelocity)
            {
                throw RecordingError.Of(file, "keys speed_mps and velocity_mps", "one of them");
            }
            if (hasSpeed || hasVelocity)
            {
                values.Remove(hasSpeed ? "velocity_mps" : "speed_mps");
            }
            foreach (KeyValuePair<string, JsonValue> member in document)
            {
                values[member.Key] = (member.Value, file);
            }
        }

        private static IReadOnlyDictionary<string, JsonValue> DocumentOf(string file, byte[] bytes)
        {
            string expected = "a JSON object with keys of " + string.Join(", ", Keys);
            try
            {
                return JsonValue.Parse(Encoding.UTF8.GetString(bytes).TrimStart('\ufeff')).AsObject();
            }
            catch (FormatException error)
            {
                throw RecordingError.Of(file, error.Message, expected);
            }
        }

        /// <summary>Reads every value once, so that errors are reported now rather than at first use.</summary>
        private void CheckAll()
        {
            _ = (Label, Licence, Source, Motion, FullScaleMps2, ForceNewtons, RateHz, VelocityMps);
        }

        private string Text(string key)
        {
            if (!values.TryGetValue(key, out (JsonValue Value, string File) found))
            {
                return "";
            }
            return found.Value.Text?.Trim() ?? throw Failure(found, key, "a text in quotes");
        }

        private double? Number(string key, double lowest, double highest, string expected)
        {
            if (!values.TryGetValue(key, out (JsonValue Value, string File) found))
            {
                return null;
            }
            return found.Value.Number is { } number && number >= lowest && number <= highest
                ? number
                : throw Failure(found, key, expected);
        }

        private (double X, double Y)? PairOf(string key)
        {
            if (!values.TryGetValue(key, out (JsonValue Value, string File) found))
            {
                return null;
            }
            double[] pair = found.Value.Elements?.Select(each => each.Number).OfType<double>().ToArray() ??
                Array.Empty<double>();
            return pair.Length == 2 && Math.Sqrt(pair[0] * pair[0] + pair[1] * pair[1]) <= MaximumSpeedMps
                ? (pair[0], pair[1])
                : throw Failure(found, key, "[vx, vy] in metres a second, 10 at most (a thousandth of mm/s)");
        }

        private static HaptoFlowException Failure((JsonValue Value, string File) found, string key, string expected) =>
            RecordingError.Of(found.File, $"key '{key}' is {JsonText.Of(found.Value)}", expected);
    }
}
