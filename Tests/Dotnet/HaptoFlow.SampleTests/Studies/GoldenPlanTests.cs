using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.Model;
using HaptoFlow.Studies;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.SampleTests
{
    /// <summary>The plans of the studies equal those of the training package exactly.</summary>
    public sealed class GoldenPlanTests
    {
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
    }
}
