#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using HaptoFlow.Studies;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>Gives all methods the delay of the slowest, by adding an artificial delay to the others.</summary>
    public sealed class EqualDelay
    {
        /// <summary>The reserve above the delay of the slowest method. With it, a session that is resumed after an
        /// interruption, and measured again, can get the same delay.</summary>
        public const double ReserveMilliseconds = 2.0;

        private readonly Dictionary<string, SystemDelay> delays;

        /// <param name="delays">The delay of the system with each method.</param>
        /// <param name="milliseconds">The delay that every method shall have; null for that of the slowest method plus
        /// <see cref="ReserveMilliseconds"/>.</param>
        /// <exception cref="StudyException">A method is too slow or too fast; the message names it.</exception>
        public EqualDelay(IReadOnlyDictionary<string, SystemDelay> delays, double? milliseconds)
        {
            this.delays = delays.ToDictionary(each => each.Key, each => each.Value, StringComparer.Ordinal);
            Slowest = delays.OrderByDescending(each => each.Value.TotalMilliseconds).First().Key;
            Milliseconds = milliseconds ??
                Math.Ceiling(delays[Slowest].TotalMilliseconds + ReserveMilliseconds);
            foreach (KeyValuePair<string, SystemDelay> each in delays)
            {
                if (!each.Value.Reaches(Milliseconds))
                {
                    throw new StudyException(FormattableString.Invariant(
                        $"method \"{each.Key}\" cannot have a delay of {Milliseconds:0.###} ms: its system delay is ") +
                        each.Value + FormattableString.Invariant(
                        $", and at most {SystemDelay.MaximumArtificialMilliseconds:0} ms can be added; ") +
                        "close other programs, or change Equal Delay Milliseconds before the first participant");
                }
            }
        }

        /// <summary>The total delay of every method.</summary>
        public double Milliseconds { get; }

        /// <summary>The method with the longest delay of the system.</summary>
        public string Slowest { get; }

        /// <summary>The delay of the system with a method, without the artificial part.</summary>
        public SystemDelay Of(string method) => delays[method];

        /// <summary>The artificial delay that the output has to add for a method.</summary>
        public double ArtificialMilliseconds(string method) => delays[method].ArtificialMilliseconds(Milliseconds);

        /// <summary>The delay of an interrupted session, read from its log; null without such a session.</summary>
        /// <param name="folder">The folder of the logs.</param>
        /// <exception cref="StudyException">A log exists and cannot be read.</exception>
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

        /// <summary>The delay in a log's first complete row.</summary>
        private static double? DelayOf(string path)
        {
            string[] lines = File.ReadAllText(path).Split('\n');
            // The last line is empty, or incomplete after a crash.
            if (lines.Length <= 2)
            {
                return null;
            }
            int column = Array.IndexOf(lines[0].Split(','), "delay_ms");
            string[] fields = lines[1].Split(',');
            bool hasDelay = column >= 0 && column < fields.Length;
            return hasDelay && double.TryParse(
                fields[column], NumberStyles.Float, CultureInfo.InvariantCulture, out double milliseconds)
                ? milliseconds
                : (double?)null;
        }
    }
}
