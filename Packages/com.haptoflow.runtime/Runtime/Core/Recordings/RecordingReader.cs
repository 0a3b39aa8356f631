#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;

namespace HaptoFlow.Recordings
{
    /// <summary>Reads recordings: a CSV table or a WAV file, and the files beside it. The formats are described in
    /// own-materials.md. Any thread that may block for the disk.</summary>
    public static class RecordingReader
    {
        private const double MaximumSeconds = 600.0;

        /// <summary>Reads a file with the files NAME.json, recordings.json and motion file beside it.</summary>
        /// <param name="path">Path of a .csv or .wav file.</param>
        /// <param name="fullScaleMps2">The acceleration of +-1 for a WAV file whose sidecar does not give it; null for
        /// none.</param>
        /// <exception cref="HaptoFlowException">Names the file, what was found, what is expected and the remedy.
        /// </exception>
        public static Recording Read(string path, double? fullScaleMps2 = null)
        {
            string folder = Path.GetDirectoryName(path) ?? "";
            byte[] file = Bytes(path) ?? throw RecordingError.Of(path, "is not there", "a .csv or .wav file");
            return Read(Path.GetFileName(path), file, name => Bytes(Path.Combine(folder, name)), fullScaleMps2);
        }

        /// <summary>Reads bytes, for recordings that are part of an application.</summary>
        /// <param name="name">Name of the file with its extension: .csv or .wav; a further .bytes is removed.</param>
        /// <param name="sibling">Returns the bytes of a file beside it, by name; null where there is none.</param>
        /// <param name="fullScaleMps2">The acceleration of +-1 for a WAV file whose sidecar does not give it; null for
        /// none.</param>
        /// <exception cref="HaptoFlowException">Names the file, what was found, what is expected and the remedy.
        /// </exception>
        public static Recording Read(
            string name, byte[] file, Func<string, byte[]?> sibling, double? fullScaleMps2 = null)
        {
            string whole = name.EndsWith(".bytes", StringComparison.OrdinalIgnoreCase)
                ? name.Substring(0, name.Length - ".bytes".Length)
                : name;
            string stem = Path.GetFileNameWithoutExtension(whole);
            RecordingSidecar sidecar = RecordingSidecar.Read(
                stem + ".json", sibling(stem + ".json"), sibling(RecordingSidecar.DefaultsFile));
            string ending = Path.GetExtension(whole).ToLowerInvariant();
            if (ending != ".csv" && ending != ".wav")
            {
                throw RecordingError.Of(whole, $"ending \"{ending}\"", "a .csv table or a .wav file");
            }
            RecordingTable? table = ending == ".csv"
                ? RecordingTable.Read(whole, file, sidecar.RateHz, true)
                : null;
            Series acceleration = table?.Acceleration ?? WaveOf(whole, file, sidecar, fullScaleMps2);
            RecordingChecks.CheckAcceleration(whole, acceleration);
            return Made(stem, whole, acceleration, table, MotionOf(whole, sidecar, sibling), sidecar);
        }

        private static RecordingTable? MotionOf(
            string file, RecordingSidecar sidecar, Func<string, byte[]?> sibling)
        {
            if (sidecar.Motion.Length == 0)
            {
                return null;
            }
            if (!StaysInFolder(sidecar.Motion))
            {
                throw RecordingError.Of(sidecar.File,
                    $"key 'motion' names {sidecar.Motion}, which is outside the folder of {sidecar.File}",
                    "a table beside the recording: copy it there");
            }
            byte[] bytes = sibling(sidecar.Motion) ?? throw RecordingError.Of(sidecar.File,
                $"key 'motion' names {sidecar.Motion}, which is not there", "a table beside " + file);
            return RecordingTable.Read(sidecar.Motion, bytes, null, false);
        }

        /// <summary>A name in a file leads no further than its own folder.</summary>
        private static bool StaysInFolder(string name) =>
            !Path.IsPathRooted(name) && name.IndexOf(':') < 0 && !name.Split('/', '\\').Contains("..");

        private static Series WaveOf(string file, byte[] bytes, RecordingSidecar sidecar, double? fullScaleMps2)
        {
            RecordingWave wave = RecordingWave.Read(file, bytes);
            double scale = sidecar.FullScaleMps2 ?? fullScaleMps2 ?? throw RecordingError.Of(sidecar.File,
                $"no key 'full_scale_mps2' for {file}",
                "\"full_scale_mps2\": the acceleration in m/s^2 that +-1 stands for");
            int count = wave.Samples.Length / wave.Channels;
            double[] seconds = Enumerable.Range(0, count).Select(index => index / (double)wave.RateHz).ToArray();
            double[][] axes = Enumerable.Range(0, wave.Channels).Select(channel => Enumerable.Range(0, count)
                .Select(index => scale * wave.Samples[index * wave.Channels + channel]).ToArray()).ToArray();
            return new Series(seconds, axes, axes.Select((_, channel) => $"channel {channel + 1}").ToArray());
        }

        private static Recording Made(string name, string file, Series acceleration, RecordingTable? table,
            RecordingTable? motionTable, RecordingSidecar sidecar)
        {
            double first = acceleration.Seconds[0];
            double last = acceleration.Seconds[acceleration.Count - 1];
            double rateHz = RateOf(file, acceleration);
            int count = 1 + (int)Math.Round((last - first) * rateHz);
            if (last - first > MaximumSeconds)
            {
                throw RecordingError.Of(file, FormattableString.Invariant($"{last - first:0} s"),
                    "10 s, and 600 s at most: cut it");
            }
            double[][] axes = acceleration.Values.Select((_, axis) =>
                acceleration.At(axis, first, 1.0 / rateHz, count)).ToArray();
            var samples = new float[axes.Length * count];
            for (int index = 0; index < samples.Length; ++index)
            {
                samples[index] = (float)axes[index % axes.Length][index / axes.Length];
            }
            Series? motion = motionTable?.Motion ?? table?.Motion;
            Series? force = motionTable?.Force ?? table?.Force;
            return new Recording(name, rateHz, axes.Length, samples)
            {
                VelocityMps = motion == null ? null : RecordingMotion.Velocity(file, motion, first, rateHz, count),
                ConstantVelocityMps = motion == null ? sidecar.VelocityMps : null,
                ForceNewtons = force == null ? null : RecordingMotion.Force(file, force, first, rateHz, count),
                ConstantForceNewtons = force == null ? sidecar.ForceNewtons : null,
                Label = sidecar.Label,
                Licence = sidecar.Licence,
                Source = sidecar.Source,
                Remarks = RemarksOf(file, table, motionTable),
            };
        }

        private static double RateOf(string file, Series acceleration)
        {
            // Times are often written with few digits: the mean interval counts, without gaps of lost samples.
            double maximumStep = 1.5 * acceleration.StepSeconds;
            double seconds = 0.0;
            int steps = 0;
            for (int row = 1; row < acceleration.Count; ++row)
            {
                double step = acceleration.Seconds[row] - acceleration.Seconds[row - 1];
                seconds += step <= maximumStep ? step : 0.0;
                steps += step <= maximumStep ? 1 : 0;
            }
            double rateHz = steps / seconds;
            return rateHz >= RecordingSidecar.MinimumRateHz - 1.0 && rateHz <= RecordingSidecar.MaximumRateHz + 1.0
                ? rateHz
                : throw RecordingError.Of(
                    file, FormattableString.Invariant($"{rateHz:0.#} samples a second"), "1000 to 192000");
        }

        private static IReadOnlyList<string> RemarksOf(string file, params RecordingTable?[] tables) => tables
            .Where(table => table?.Unknown.Count > 0)
            .Select(table => $"{file}: ignored columns {string.Join(", ", table!.Unknown)}.")
            .ToArray();

        /// <summary>Null where there is no such file.</summary>
        private static byte[]? Bytes(string path)
        {
            try
            {
                return File.Exists(path) ? File.ReadAllBytes(path) : null;
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                throw RecordingError.Of(path, $"cannot be read ({error.Message})", "a file that can be opened");
            }
        }
    }
}
