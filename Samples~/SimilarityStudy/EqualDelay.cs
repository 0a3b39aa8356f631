#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using HaptoFlow.Studies;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>One delay for all methods: that of the slowest. The faster ones are delayed by what is missing.
    /// </summary>
    public sealed class EqualDelay
    {
        /// <summary>Above the slowest method, so that a session that goes on after an interruption, and is measured
        /// anew, can still be given the same.</summary>
        public const double ReserveMilliseconds = 2.0;

        private readonly Dictionary<string, SystemDelay> delays;

        /// <param name="delays">Of the system with each method.</param>
        /// <param name="wantedMilliseconds">Null for that of the slowest method and <see cref="ReserveMilliseconds"/>.
        /// </param>
        /// <exception cref="StudyException">A method is too slow for what is wanted, or too fast; the message names it.
        /// </exception>
        public EqualDelay(IReadOnlyDictionary<string, SystemDelay> delays, double? wantedMilliseconds)
        {
            this.delays = delays.ToDictionary(each => each.Key, each => each.Value, StringComparer.Ordinal);
            Slowest = delays.OrderByDescending(each => each.Value.TotalMilliseconds).First().Key;
            Milliseconds = wantedMilliseconds ??
                Math.Ceiling(delays[Slowest].TotalMilliseconds + ReserveMilliseconds);
            foreach (KeyValuePair<string, SystemDelay> each in delays)
            {
                if (!each.Value.Reaches(Milliseconds))
                {
                    throw new StudyException(FormattableString.Invariant(
                        $"method \"{each.Key}\" cannot be given {Milliseconds:0.###} ms: its system delay is ") +
                        each.Value + FormattableString.Invariant(
                        $", and at most {SystemDelay.MaximumArtificialMilliseconds:0} ms can be added; ") +
                        "close other programs, or change Equal Delay Milliseconds before the first participant");
                }
            }
        }

        /// <summary>What every method gets in all.</summary>
        public double Milliseconds { get; }

        /// <summary>The method with the longest delay of its own.</summary>
        public string Slowest { get; }

        /// <summary>Of the system with the method, nothing added.</summary>
        public SystemDelay Of(string method) => delays[method];

        /// <summary>What the output has to add for the method.</summary>
        public double ArtificialMilliseconds(string method) => delays[method].ArtificialMilliseconds(Milliseconds);

        /// <summary>What the answers of an interrupted session were given with; null where there is none yet.</summary>
        /// <param name="folder">Of the logs.</param>
        /// <exception cref="StudyException">A log is there and cannot be read.</exception>
        public static double? OfInterrupted(string folder, int participant)
        {
            try
            {
                return Directory.Exists(folder)
                    ? Directory.GetFiles(folder, $"similarity-P{participant:00}-*.csv").Select(DelayOf)
                        .FirstOrDefault(each => each != null)
                    : null;
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                throw new StudyException($"{folder}: {error.Message}; close the program that holds the file", error);
            }
        }

        /// <summary>Of a log's first whole row.</summary>
        private static double? DelayOf(string path)
        {
            string[] lines = File.ReadAllText(path).Split('\n');
            // The last line is empty, or torn by a crash.
            if (lines.Length <= 2)
            {
                return null;
            }
            int column = Array.IndexOf(lines[0].Split(','), "delay_ms");
            string[] fields = lines[1].Split(',');
            bool isThere = column >= 0 && column < fields.Length;
            return isThere && double.TryParse(
                fields[column], NumberStyles.Float, CultureInfo.InvariantCulture, out double milliseconds)
                ? milliseconds
                : (double?)null;
        }
    }
}
