#nullable enable
using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.Model;
using HaptoFlow.Studies;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.SampleTests
{
    /// <summary>Orders of trials. That they are balanced is tested with the training package, whose plans these equal.</summary>
    public sealed class StudyPlanTests
    {
        private static readonly double[] Levels = Enumerable.Range(0, 11).Select(step => 50.0 + 20.0 * step).ToArray();
        private static readonly string[] Materials = { "ceramic", "jute", "wood", "plastic", "fur", "metal" };
        private static readonly string[] Methods = { "haptoflow", "transformer", "dstn", "spsi" };
        private static readonly JsonValue Golden =
            JsonValue.Parse(File.ReadAllText(RepositoryFiles.In("Tests", "Golden", "studies", "plans.json")));

        private static IReadOnlyList<JsonValue> Cases(string key)
        {
            IReadOnlyList<JsonValue> cases = Golden[key].AsArray();
            Assert.That(cases, Is.Not.Empty, key);
            return cases;
        }

        [Test]
        public void RandomNumbersEqualThoseOfPython()
        {
            foreach (JsonValue each in Cases("random"))
            {
                var random = new SplitMix64(each["seed"].AsUnsigned64());
                ulong[] expected = each["values"].AsArray().Select(value => value.AsUnsigned64()).ToArray();
                Assert.That(expected.Select(_ => random.Next()), Is.EqualTo(expected));
            }
        }

        [Test]
        public void ShufflesEqualThoseOfPython()
        {
            foreach (JsonValue each in Cases("shuffles"))
            {
                Assert.That(SplitMix64.Shuffle(each["count"].AsInteger(), each["seed"].AsUnsigned64()),
                    Is.EqualTo(Integers(each["order"])));
            }
        }

        [Test]
        public void DesignsEqualThoseOfPython()
        {
            foreach (JsonValue each in Cases("williams"))
            {
                Assert.That(WilliamsDesign.Rows(each["count"].AsInteger()),
                    Is.EqualTo(each["rows"].AsArray().Select(Integers)));
            }
        }

        [Test]
        public void LatencyPlansEqualThoseOfPython()
        {
            foreach (JsonValue each in Cases("latency"))
            {
                double[] levels = each["levels_ms"].AsArray().Select(level => level.AsNumber()).ToArray();
                StudyPlan plan = StudyPlan.Latency(
                    each["participant"].AsInteger(), each["seed"].AsUnsigned64(), levels);
                Assert.That(
                    plan.Trials.Select(trial =>
                        (trial.Trial, trial.Block, trial.Condition, trial.DelayMilliseconds!.Value)),
                    Is.EqualTo(each["plan"].AsArray().Select(trial => (trial["trial"].AsInteger(),
                        trial["block"].AsText(), trial["condition"].AsText(), trial["delay_ms"].AsNumber()))));
            }
        }

        [Test]
        public void SimilarityPlansEqualThoseOfPython()
        {
            foreach (JsonValue each in Cases("similarity"))
            {
                StudyPlan plan = StudyPlan.Similarity(each["participant"].AsInteger(), each["seed"].AsUnsigned64(),
                    Texts(each["materials"]), Texts(each["methods"]));
                Assert.That(plan.Trials.Select(trial => (trial.Trial, trial.Block, trial.Material, trial.Method)),
                    Is.EqualTo(each["plan"].AsArray().Select(trial => (trial["trial"].AsInteger(),
                        trial["block"].AsText(), trial["material"].AsText(), trial["method"].AsText()))));
            }
        }

        private static int[] Integers(JsonValue array) =>
            array.AsArray().Select(each => each.AsInteger()).ToArray();

        private static string[] Texts(JsonValue array) => array.AsArray().Select(each => each.AsText()).ToArray();

        // Neither is part of the golden plans, since the training package rests and mounts nothing.
        [Test]
        public void ASessionRestsBeforeTheMainTrialsBetweenConditionsAndAfterTwelveTrials()
        {
            Assert.That(Rests(StudyPlan.Latency(2, 1, Levels)), Is.EqualTo(new[] { 5, 16 }));
            Assert.That(Rests(StudyPlan.Similarity(2, 5, Materials, Methods)), Is.EqualTo(new[] { 5, 17 }));
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

        private static IEnumerable<int> Rests(StudyPlan plan) =>
            plan.Trials.Where(trial => trial.RestBefore).Select(trial => trial.Trial);

        private static NUnit.Framework.Constraints.IResolveConstraint Refusal(string message) =>
            Throws.TypeOf<StudyException>().With.Message.Contains(message);
    }
}
