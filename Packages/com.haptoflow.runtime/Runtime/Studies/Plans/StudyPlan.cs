#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Studies
{
    /// <summary>The order of a study's trials for one participant, counterbalanced over participants and shuffled by a
    /// seed: the same in the training package. Any thread.</summary>
    public sealed class StudyPlan
    {
        /// <summary>The pen begins to move and the vibration begins.</summary>
        public const string TurnOn = "turn-on";

        /// <summary>The pen stops and the vibration stops.</summary>
        public const string TurnOff = "turn-off";

        /// <summary>Main trials of the similarity study between two rests.</summary>
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

        /// <summary>Which study it is.</summary>
        public StudyKind Kind { get; }

        /// <summary>From 1.</summary>
        public int Participant { get; }

        /// <summary>What the order is shuffled by, equal for all participants of a study.</summary>
        public ulong Seed { get; }

        /// <summary>In their order.</summary>
        public IReadOnlyList<PlannedTrial> Trials => trials;

        /// <summary>The latency study: four practice trials, then every level under one condition and every level under
        /// the other. Participants with an odd number begin with <see cref="TurnOn"/>. Each level stands equally often
        /// at each place of each condition once every row of the levels' design was used. A rest comes before the main
        /// trials and between the conditions.</summary>
        /// <param name="participant">From 1.</param>
        /// <param name="levelsMilliseconds">Delays in all, each once, above 0.</param>
        /// <exception cref="StudyException">A level or the participant is unusable; the message names it.</exception>
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
            // Those who begin with a condition have rows of one parity: an even step leaves the rest of the rows to the
            // others.
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
        /// methods one after another. Materials change places with each participant. The rows of methods move on once
        /// the participants have used every order of materials, so that each method comes equally often at each place
        /// of each material. A rest comes before the main trials and after every <see cref="TrialsBetweenRests"/> of
        /// them.</summary>
        /// <param name="participant">From 1.</param>
        /// <param name="materials">Names, each once, without comma, quotation mark or line break.</param>
        /// <param name="methods">As the materials.</param>
        /// <exception cref="StudyException">A name or the participant is unusable; the message names it.</exception>
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
                        $"levels_ms: {level} ms is no delay; expected more than 0"));
                }
                if (levels.Count(each => each.Equals(level)) > 1)
                {
                    throw new StudyException(FormattableString.Invariant(
                        $"levels_ms: {level} ms is there twice; expected each level once"));
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
                        $"{key}: \"{name}\" cannot stand in a log; expected a name without comma, quotation mark or " +
                        "line break");
                }
                if (names.Count(each => string.Equals(each, name, StringComparison.Ordinal)) > 1)
                {
                    throw new StudyException($"{key}: \"{name}\" is there twice; expected each name once");
                }
            }
        }
    }
}
