#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Studies
{
    /// <summary>The order of a study's trials for one participant, counterbalanced over participants and shuffled by a
    /// seed, identical to the training package's. Any thread.</summary>
    public sealed class StudyPlan
    {
        /// <summary>Condition in which the vibration follows the start of the pen's motion.</summary>
        public const string TurnOn = "turn-on";

        /// <summary>Condition in which the end of the vibration follows the end of the pen's motion.</summary>
        public const string TurnOff = "turn-off";

        /// <summary>Number of main trials of the similarity study between two rests.</summary>
        public const int TrialsBetweenRests = 12;

        private readonly List<PlannedTrial> trials = new List<PlannedTrial>();

        private StudyPlan(StudyKind kind, int participant, ulong seed)
        {
            if (participant < 1)
            {
                throw new StudyException($"participant {participant}: participants are numbered from 1");
            }
            Kind = kind;
            Participant = participant;
            Seed = seed;
        }

        /// <summary>The kind of study.</summary>
        public StudyKind Kind { get; }

        /// <summary>Number of the participant, from 1.</summary>
        public int Participant { get; }

        /// <summary>Seed of the shuffling, equal for all participants of a study.</summary>
        public ulong Seed { get; }

        /// <summary>The trials in order.</summary>
        public IReadOnlyList<PlannedTrial> Trials => trials;

        /// <summary>The latency study: four practice trials, then every level in one condition and every level in the
        /// other. Participants with odd numbers begin with <see cref="TurnOn"/>. Once every row of the levels' design
        /// was used, each level has been equally often at each position of each condition. There is a rest before the
        /// main trials and between the conditions.</summary>
        /// <param name="participant">Number of the participant, from 1.</param>
        /// <param name="levelsMilliseconds">Total delays, different and above 0.</param>
        /// <exception cref="StudyException">A level or the participant is not valid; the message names it.</exception>
        public static StudyPlan Latency(int participant, ulong seed, IReadOnlyList<double> levelsMilliseconds)
        {
            var plan = new StudyPlan(StudyKind.Latency, participant, seed);
            CheckLevels(levelsMilliseconds);
            string[] conditions = participant % 2 == 1 ? new[] { TurnOn, TurnOff } : new[] { TurnOff, TurnOn };
            foreach (string condition in conditions)
            {
                plan.AddLatency(PlannedTrial.Practice, false, condition, levelsMilliseconds.Min());
                plan.AddLatency(PlannedTrial.Practice, false, condition, levelsMilliseconds.Max());
            }
            int[] names = SplitMix64.Shuffle(levelsMilliseconds.Count, seed);
            int[][] rows = WilliamsDesign.Rows(names.Length);
            int row = (participant - 1) % rows.Length;
            // Participants who begin with the same condition use rows of one parity; an even step leaves the other rows
            // to the others.
            int half = rows.Length / 2;
            int step = half + half % 2;
            foreach (string condition in conditions)
            {
                bool isFirst = true;
                foreach (int entry in rows[row])
                {
                    plan.AddLatency(PlannedTrial.Main, isFirst, condition, levelsMilliseconds[names[entry]]);
                    isFirst = false;
                }
                row = (row + step) % rows.Length;
            }
            return plan;
        }

        /// <summary>The similarity study: every method on the first material for practice, then each material with all
        /// methods in succession. The order of materials changes with each participant. The rows of methods advance
        /// once the participants have used every order of materials, so that each method is equally often at each
        /// position of each material. There is a rest before the main trials and after every <see
        /// cref="TrialsBetweenRests"/> of them.</summary>
        /// <param name="participant">Number of the participant, from 1.</param>
        /// <param name="materials">Different names without comma, quotation mark or line break.</param>
        /// <param name="methods">Different names without comma, quotation mark or line break.</param>
        /// <exception cref="StudyException">A name or the participant is not valid; the message names it.</exception>
        public static StudyPlan Similarity(
            int participant, ulong seed, IReadOnlyList<string> materials, IReadOnlyList<string> methods)
        {
            var plan = new StudyPlan(StudyKind.Similarity, participant, seed);
            CheckNames("materials", materials);
            CheckNames("methods", methods);
            foreach (string method in methods)
            {
                plan.AddSimilarity(PlannedTrial.Practice, false, materials[0], method);
            }
            int[] materialNames = SplitMix64.Shuffle(materials.Count, seed);
            int[][] materialRows = WilliamsDesign.Rows(materials.Count);
            int[][] methodRows = WilliamsDesign.Rows(methods.Count);
            int methodRow = (participant - 1) / materialRows.Length;
            int shown = 0;
            foreach (int entry in materialRows[(participant - 1) % materialRows.Length])
            {
                int material = materialNames[entry];
                int[] methodNames = SplitMix64.Shuffle(methods.Count, unchecked(seed + 1ul + (ulong)material));
                foreach (int method in methodRows[methodRow % methodRows.Length])
                {
                    bool rests = shown % TrialsBetweenRests == 0;
                    plan.AddSimilarity(PlannedTrial.Main, rests, materials[material], methods[methodNames[method]]);
                    ++shown;
                }
                ++methodRow;
            }
            return plan;
        }

        private void AddLatency(string block, bool restBefore, string condition, double delayMilliseconds) =>
            trials.Add(new PlannedTrial(trials.Count + 1, block, restBefore)
            {
                Condition = condition,
                DelayMilliseconds = delayMilliseconds,
            });

        private void AddSimilarity(string block, bool restBefore, string material, string method)
        {
            PlannedTrial? before = trials.LastOrDefault();
            trials.Add(new PlannedTrial(trials.Count + 1, block, restBefore)
            {
                Material = material,
                Method = method,
                ChangesSample = before != null && !string.Equals(before.Material, material, StringComparison.Ordinal),
            });
        }

        private static void CheckLevels(IReadOnlyList<double> levels)
        {
            if (levels.Count == 0)
            {
                throw new StudyException("levels_ms: a study needs at least one delay level");
            }
            foreach (double level in levels)
            {
                if (!(level > 0.0) || double.IsInfinity(level))
                {
                    throw new StudyException(FormattableString.Invariant(
                        $"levels_ms: {level} ms is not a delay; expected more than 0"));
                }
                if (levels.Count(each => each.Equals(level)) > 1)
                {
                    throw new StudyException(FormattableString.Invariant(
                        $"levels_ms: {level} ms occurs twice; expected each level once"));
                }
            }
        }

        private static void CheckNames(string key, IReadOnlyList<string> names)
        {
            if (names.Count == 0)
            {
                throw new StudyException($"{key}: a study needs at least one");
            }
            foreach (string name in names)
            {
                if (name.Trim().Length == 0 || name.Any(letter => letter == ',' || letter == '"' || letter < ' '))
                {
                    throw new StudyException(
                        $"{key}: \"{name}\" is not valid; expected a name without comma, quotation mark or " +
                        "line break");
                }
                if (names.Count(each => string.Equals(each, name, StringComparison.Ordinal)) > 1)
                {
                    throw new StudyException($"{key}: \"{name}\" occurs twice; expected each name once");
                }
            }
        }
    }

    /// <summary>A trial of a plan. Properties that the study does not vary are null.</summary>
    public sealed class PlannedTrial
    {
        /// <summary>Value of <see cref="Block"/> for trials to become familiar with the task.</summary>
        public const string Practice = "practice";

        /// <summary>Value of <see cref="Block"/> for trials that are analysed.</summary>
        public const string Main = "main";

        internal PlannedTrial(int trial, string block, bool restBefore) =>
            (Trial, Block, RestBefore) = (trial, block, restBefore);

        /// <summary>Number of the trial in the plan, from 1.</summary>
        public int Trial { get; }

        /// <summary><see cref="Practice"/> or <see cref="Main"/>.</summary>
        public string Block { get; }

        /// <summary>True where the study pauses before this trial until the operator continues.</summary>
        public bool RestBefore { get; }

        /// <summary>Similarity study: true where the previous trial had another material, so that the operator has to
        /// mount another sample first.</summary>
        public bool ChangesSample { get; internal set; }

        /// <summary>Latency study: <see cref="StudyPlan.TurnOn"/> or <see cref="StudyPlan.TurnOff"/>.</summary>
        public string? Condition { get; internal set; }

        /// <summary>Latency study: planned delay from the hand's motion to the vibration's change, in ms.</summary>
        public double? DelayMilliseconds { get; internal set; }

        /// <summary>Similarity study: the material's name in the settings.</summary>
        public string? Material { get; internal set; }

        /// <summary>Similarity study: the method's name in the settings.</summary>
        public string? Method { get; internal set; }

        /// <summary>True for a trial of the practice block.</summary>
        public bool IsPractice => string.Equals(Block, Practice, StringComparison.Ordinal);
    }

    /// <summary>Orders of treatments in which each treatment is once at each position and follows each other treatment
    /// equally often: Williams (1949), Experimental designs balanced for the estimation of residual effects of
    /// treatments. Any thread.</summary>
    public static class WilliamsDesign
    {
        /// <summary>The rows of the design: as many as treatments for an even number, twice as many for an odd one, and
        /// one row for one treatment.</summary>
        /// <param name="count">Number of treatments, 1 or more.</param>
        /// <exception cref="ArgumentOutOfRangeException">The count is below 1.</exception>
        public static int[][] Rows(int count)
        {
            if (count < 1)
            {
                throw new ArgumentOutOfRangeException(nameof(count), count, "a design has at least one treatment");
            }
            int[][] rows = Enumerable.Range(0, count).Select(shift => Row(count, shift)).ToArray();
            return count % 2 == 1 && count > 1
                ? rows.Concat(rows.Select(row => row.Reverse().ToArray())).ToArray()
                : rows;
        }

        private static int[] Row(int count, int shift) => Enumerable.Range(0, count)
            .Select(place => (shift + (place % 2 == 1 ? (place + 1) / 2 : count - place / 2)) % count).ToArray();
    }

    /// <summary>The pseudorandom numbers of study plans: Steele, Lea and Flood (2014), Fast splittable pseudorandom
    /// number generators. System.Random cannot reproduce the training package's plans; this generator is the same
    /// there. One thread at a time.</summary>
    public sealed class SplitMix64
    {
        private ulong state;

        /// <summary>Starts the sequence of a seed.</summary>
        public SplitMix64(ulong seed) => state = seed;

        /// <summary>The numbers 0 to count - 1, shuffled by a seed (Fisher and Yates, from the end).</summary>
        /// <param name="count">0 or more.</param>
        public static int[] Shuffle(int count, ulong seed)
        {
            var random = new SplitMix64(seed);
            int[] order = Enumerable.Range(0, count).ToArray();
            for (int index = count - 1; index > 0; --index)
            {
                int other = (int)(random.Next() % (ulong)(index + 1));
                (order[index], order[other]) = (order[other], order[index]);
            }
            return order;
        }

        /// <summary>The next number, 0 to 2^64 - 1.</summary>
        public ulong Next()
        {
            unchecked
            {
                state += 0x9E3779B97F4A7C15ul;
                ulong mixed = state;
                mixed = (mixed ^ (mixed >> 30)) * 0xBF58476D1CE4E5B9ul;
                mixed = (mixed ^ (mixed >> 27)) * 0x94D049BB133111EBul;
                return mixed ^ (mixed >> 31);
            }
        }
    }
}
