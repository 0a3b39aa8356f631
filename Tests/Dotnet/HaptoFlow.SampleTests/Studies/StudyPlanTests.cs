#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Studies;
using NUnit.Framework;

namespace HaptoFlow.Tests
{
    /// <summary>Orders of trials: balanced within and across participants, and reproducible from the seed.</summary>
    public sealed class StudyPlanTests
    {
        private static readonly double[] Levels = Enumerable.Range(0, 11).Select(step => 50.0 + 20.0 * step).ToArray();
        private static readonly string[] Materials = { "ceramic", "jute", "wood", "plastic", "fur", "metal" };
        private static readonly string[] Methods = { "haptoflow", "transformer", "dstn", "spsi" };

        [TestCase(2)]
        [TestCase(4)]
        [TestCase(5)]
        [TestCase(6)]
        [TestCase(11)]
        public void EachTreatmentIsAtEachPositionAndFollowsEachOtherEquallyOften(int count)
        {
            int[][] rows = WilliamsDesign.Rows(count);
            int repeats = count % 2 == 0 ? 1 : 2;
            Assert.That(rows, Has.Length.EqualTo(repeats * count));
            var places = new int[count, count];
            var follows = new int[count, count];
            foreach (int[] row in rows)
            {
                Assert.That(row, Is.EquivalentTo(Enumerable.Range(0, count)));
                for (int place = 0; place < count; ++place)
                {
                    ++places[row[place], place];
                    if (place > 0)
                    {
                        ++follows[row[place - 1], row[place]];
                    }
                }
            }
            Assert.That(places.Cast<int>(), Has.All.EqualTo(repeats));
            for (int before = 0; before < count; ++before)
            {
                for (int after = 0; after < count; ++after)
                {
                    Assert.That(follows[before, after], Is.EqualTo(before == after ? 0 : repeats));
                }
            }
        }

        [Test]
        public void TheSampleChangesExactlyWhereTheMaterialChanges()
        {
            StudyPlan plan = StudyPlan.Similarity(7, 5, Materials, Methods);
            Assert.That(plan.Trials[0].ChangesSample, Is.False);
            for (int place = 1; place < plan.Trials.Count; ++place)
            {
                Assert.That(plan.Trials[place].ChangesSample,
                    Is.EqualTo(plan.Trials[place].Material != plan.Trials[place - 1].Material));
            }
            Assert.That(StudyPlan.Latency(7, 5, Levels).Trials.Select(trial => trial.ChangesSample),
                Has.All.False);
        }

        [Test]
        public void EveryLevelOccursOnceInEachConditionAfterFourPracticeTrials(
            [Values(1, 2, 23, 24, 1000)] int participant, [Values(0ul, 1ul, ulong.MaxValue)] ulong seed)
        {
            StudyPlan plan = StudyPlan.Latency(participant, seed, Levels);
            Assert.That(plan.Trials.Select(trial => trial.Trial), Is.EqualTo(Enumerable.Range(1, 26)));
            Assert.That(plan.Trials.Take(4).Select(trial => trial.DelayMilliseconds),
                Is.EqualTo(new[] { 50.0, 250.0, 50.0, 250.0 }));
            Assert.That(plan.Trials.Where(trial => trial.IsPractice).Select(trial => trial.Trial),
                Is.EqualTo(new[] { 1, 2, 3, 4 }));
            foreach (string condition in new[] { StudyPlan.TurnOn, StudyPlan.TurnOff })
            {
                Assert.That(plan.Trials.Skip(4).Where(trial => trial.Condition == condition)
                    .Select(trial => trial.DelayMilliseconds), Is.EquivalentTo(Levels));
            }
        }

        [Test]
        public void HalfOfTheParticipantsBeginWithTurnOnAndConditionsAreNotMixed()
        {
            for (int participant = 1; participant <= 24; ++participant)
            {
                StudyPlan plan = StudyPlan.Latency(participant, 1, Levels);
                string[] conditions = plan.Trials.Skip(4).Select(trial => trial.Condition!).ToArray();
                Assert.That(conditions[0], Is.EqualTo(participant % 2 == 1 ? StudyPlan.TurnOn : StudyPlan.TurnOff));
                Assert.That(conditions.Take(11).Distinct().Count(), Is.EqualTo(1));
                Assert.That(conditions.Skip(11).Distinct().Count(), Is.EqualTo(1));
                Assert.That(plan.Trials.Where(trial => trial.RestBefore).Select(trial => trial.Trial),
                    Is.EqualTo(new[] { 5, 16 }), "after the practice, and where the condition changes");
            }
        }

        [TestCase(11, 22, 2, 2)]
        [TestCase(11, 24, 2, 4)]
        [TestCase(7, 14, 2, 2)]
        [TestCase(4, 4, 1, 1)]
        [TestCase(6, 24, 4, 4)]
        public void EachLevelIsEquallyOftenAtEachPositionOfEachCondition(
            int levels, int participants, int fewest, int most)
        {
            double[] delays = Levels.Take(levels).ToArray();
            var counts = new Dictionary<(string, double, int), int>();
            for (int participant = 1; participant <= participants; ++participant)
            {
                PlannedTrial[] main = StudyPlan.Latency(participant, 7, delays).Trials.Skip(4).ToArray();
                for (int trial = 0; trial < main.Length; ++trial)
                {
                    Count(counts, (main[trial].Condition!, main[trial].DelayMilliseconds!.Value, trial % levels));
                }
            }
            Assert.That(counts, Has.Count.EqualTo(2 * levels * levels));
            Assert.That((counts.Values.Min(), counts.Values.Max()), Is.EqualTo((fewest, most)));
        }

        [TestCase(6, 4, 24, 6)]
        [TestCase(3, 3, 36, 12)]
        [TestCase(2, 6, 12, 2)]
        public void EachMethodIsEquallyOftenAtEachPositionOfEachMaterial(
            int materials, int methods, int participants, int each)
        {
            string[] first = Enumerable.Range(0, materials).Select(index => $"material {index}").ToArray();
            string[] second = Enumerable.Range(0, methods).Select(index => $"method {index}").ToArray();
            var counts = new Dictionary<(string, string, int), int>();
            for (int participant = 1; participant <= participants; ++participant)
            {
                PlannedTrial[] main =
                    StudyPlan.Similarity(participant, 7, first, second).Trials.Skip(methods).ToArray();
                for (int trial = 0; trial < main.Length; ++trial)
                {
                    Count(counts, (main[trial].Material!, main[trial].Method!, trial % methods));
                }
            }
            Assert.That(counts, Has.Count.EqualTo(materials * methods * methods));
            Assert.That(counts.Values, Has.All.EqualTo(each));
        }

        [Test]
        public void AllMethodsOfAMaterialAreConsecutiveWithARestAfterTwelveTrials()
        {
            for (int participant = 1; participant <= 12; ++participant)
            {
                StudyPlan plan = StudyPlan.Similarity(participant, 5, Materials, Methods);
                Assert.That(plan.Trials.Take(4).Select(trial => (trial.Material, trial.Method)),
                    Is.EqualTo(Methods.Select(method => ("ceramic", method))));
                PlannedTrial[] main = plan.Trials.Skip(4).ToArray();
                Assert.That(main.Select(trial => trial.Material).Where((_, place) => place % 4 == 0),
                    Is.EquivalentTo(Materials));
                for (int material = 0; material < 6; ++material)
                {
                    PlannedTrial[] group = main.Skip(4 * material).Take(4).ToArray();
                    Assert.That(group.Select(trial => trial.Material).Distinct().Count(), Is.EqualTo(1));
                    Assert.That(group.Select(trial => trial.Method), Is.EquivalentTo(Methods));
                }
                Assert.That(plan.Trials.Where(trial => trial.RestBefore).Select(trial => trial.Trial),
                    Is.EqualTo(new[] { 5, 17 }));
            }
        }

        [Test]
        public void AnotherSeedGivesAnotherOrder() => Assert.That(
            StudyPlan.Latency(1, 2, Levels).Trials.Select(trial => trial.DelayMilliseconds),
            Is.Not.EqualTo(StudyPlan.Latency(1, 1, Levels).Trials.Select(trial => trial.DelayMilliseconds)));

        [Test]
        public void InvalidLevelsAndNamesAreRefusedByName()
        {
            Assert.That(() => StudyPlan.Latency(0, 1, Levels), Refusal("participant 0"));
            Assert.That(() => StudyPlan.Latency(1, 1, new double[0]), Refusal("levels_ms"));
            Assert.That(() => StudyPlan.Latency(1, 1, new[] { 50.0, 70.5, 70.5 }), Refusal("70.5 ms occurs twice"));
            Assert.That(() => StudyPlan.Latency(1, 1, new[] { double.NaN }), Refusal("NaN ms is not a delay"));
            Assert.That(() => StudyPlan.Latency(1, 1, new[] { -20.0 }), Refusal("-20 ms is not a delay"));
            Assert.That(() => StudyPlan.Similarity(1, 1, new[] { "a,b" }, Methods), Refusal("\"a,b\" is not valid"));
            Assert.That(() => StudyPlan.Similarity(1, 1, Materials, new[] { "x", "x" }), Refusal("occurs twice"));
            Assert.That(() => StudyPlan.Similarity(1, 1, Materials, new[] { " " }), Refusal("methods"));
        }

        private static void Count<T>(Dictionary<T, int> counts, T key) where T : notnull =>
            counts[key] = counts.TryGetValue(key, out int before) ? before + 1 : 1;

        private static NUnit.Framework.Constraints.IResolveConstraint Refusal(string message) =>
            Throws.TypeOf<StudyException>().With.Message.Contains(message);
    }
}
