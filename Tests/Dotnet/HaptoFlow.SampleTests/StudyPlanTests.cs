#nullable enable
using System;
using System.Collections;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.Model;
using HaptoFlow.Studies;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

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

        [Test]
        public void RandomNumbersEqualThoseOfPython() => Same("random",
            each =>
            {
                var random = new SplitMix64(each["seed"].AsUnsigned64());
                return each["values"].AsArray().Select(_ => random.Next());
            },
            each => each["values"].AsArray().Select(value => value.AsUnsigned64()));

        [Test]
        public void ShufflesEqualThoseOfPython() => Same("shuffles",
            each => SplitMix64.Shuffle(each["count"].AsInteger(), each["seed"].AsUnsigned64()),
            each => Integers(each["order"]));

        [Test]
        public void DesignsEqualThoseOfPython() => Same("williams",
            each => WilliamsDesign.Rows(each["count"].AsInteger()), each => each["rows"].AsArray().Select(Integers));

        [Test]
        public void LatencyPlansEqualThoseOfPython() => Same("latency",
            each => StudyPlan.Latency(each["participant"].AsInteger(), each["seed"].AsUnsigned64(),
                    each["levels_ms"].AsArray().Select(level => level.AsNumber()).ToArray())
                .Trials.Select(trial => (trial.Trial, trial.Block, trial.Condition, trial.DelayMilliseconds!.Value)),
            each => each["plan"].AsArray().Select(trial => (trial["trial"].AsInteger(),
                trial["block"].AsText(), trial["condition"].AsText(), trial["delay_ms"].AsNumber())));

        [Test]
        public void SimilarityPlansEqualThoseOfPython() => Same("similarity",
            each => StudyPlan.Similarity(each["participant"].AsInteger(), each["seed"].AsUnsigned64(),
                    Texts(each["materials"]), Texts(each["methods"]))
                .Trials.Select(trial => (trial.Trial, trial.Block, trial.Material, trial.Method)),
            each => each["plan"].AsArray().Select(trial => (trial["trial"].AsInteger(),
                trial["block"].AsText(), trial["material"].AsText(), trial["method"].AsText())));

        /// <summary>In every case of the golden file under a key, C# makes what Python made.</summary>
        private static void Same(
            string key, Func<JsonValue, IEnumerable> made, Func<JsonValue, IEnumerable> expected)
        {
            Assert.That(Golden[key].AsArray(), Is.Not.Empty, key);
            foreach (JsonValue each in Golden[key].AsArray())
            {
                Assert.That(made(each), Is.EqualTo(expected(each)));
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

    /// <summary>Statistics of a trial for a stroke of known length, time and force.</summary>
    public sealed class TrialContactTests : SceneTest
    {
        [Test]
        public void PathTimeSpeedAndForceAreMeasuredOverTheStroke()
        {
            Board();
            // 0.15 m/s, 1 mm below the surface with a tip of 2 mm radius: the penetration depth is 3 mm.
            HapticStylus stylus = StylusAlong(seconds => new Vector3(-0.15f + 0.15f * (float)seconds, 0.001f, 0f));
            FinishLoading();
            World.Frames(10);
            using var contact = new TrialContact(stylus);
            World.Frames(90);
            Assert.That(contact.ContactSeconds, Is.EqualTo(1.0).Within(0.012));
            Assert.That(contact.PathMillimetres, Is.EqualTo(150.0).Within(3.0));
            Assert.That(contact.MeanSpeedMmps, Is.EqualTo(150.0).Within(1.0));
            Assert.That(contact.MeanForceNewtons, Is.EqualTo(stylus.Contact.ForceNewtons).Within(0.01));
            Assert.That(contact.IsMoving, Is.True);
            contact.Begin();
            Assert.That((contact.ContactSeconds, contact.PathMillimetres), Is.EqualTo((0.0, 0.0)));
        }

        [Test]
        public void StartsAndStopsAreCountedAlsoWhenThePenLifts()
        {
            Board();
            HapticStylus stylus = StylusAlong(Stops);
            FinishLoading();
            using var contact = new TrialContact(stylus);
            World.Frames(45);
            Assert.That((contact.Starts, contact.Stops), Is.EqualTo((1, 0)), "the tip slides");
            World.Frames(45);
            Assert.That((contact.Starts, contact.Stops), Is.EqualTo((1, 1)), "it rests");
            World.Frames(45);
            Assert.That((contact.Starts, contact.Stops), Is.EqualTo((2, 1)), "the tip slides again");
            World.Frames(45);
            Assert.That((contact.Starts, contact.Stops), Is.EqualTo((2, 2)), "the tip was lifted");
            Assert.That(contact.ContactSeconds, Is.EqualTo(1.5).Within(0.05));
        }

        [Test]
        public void OnlyTheChosenSurfaceOfAStrokeCounts()
        {
            HapticSurface left = Board();
            HapticSurface right = Board("fur");
            right.transform.position = new Vector3(0.4f, 0f, 0f);
            // 20 cm on the left board, then 10 cm on the right one.
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.2f * (float)seconds, 0.001f, 0f));
            FinishLoading();
            using var all = new TrialContact(stylus);
            using var onLeft = new TrialContact(stylus, left);
            using var onRight = new TrialContact(stylus, right);
            World.Frames(136);
            Assert.That(onLeft.PathMillimetres, Is.EqualTo(200.0).Within(6.0));
            Assert.That(onRight.PathMillimetres, Is.EqualTo(100.0).Within(6.0));
            Assert.That(onLeft.ContactSeconds + onRight.ContactSeconds, Is.EqualTo(all.ContactSeconds).Within(1e-9));
            Assert.That((onLeft.Starts, onLeft.Stops, onRight.IsMoving), Is.EqualTo((1, 1, true)));
        }

        private static Vector3 Stops(double seconds)
        {
            double slides = Math.Min(seconds, 0.5) + Math.Max(0.0, Math.Min(seconds, 1.5) - 1.0);
            float height = seconds < 1.5 ? 0.001f : 0.05f;
            return new Vector3(-0.1f + 0.1f * (float)slides, height, 0f);
        }
    }

    /// <summary>The delay that must be added to the system's for a delay level.</summary>
    public sealed class SystemDelayTests
    {
        private static readonly SystemDelay System = new SystemDelay(13.9, 0.0, 10.7, 5.0);

        [Test]
        public void TheArtificialDelayIsWhatRemainsAfterTheFourParts()
        {
            Assert.That(System.TotalMilliseconds, Is.EqualTo(29.6).Within(1e-12));
            Assert.That(System.ArtificialMilliseconds(50.0), Is.EqualTo(20.4).Within(1e-12));
            Assert.That(System.ArtificialMilliseconds(System.TotalMilliseconds), Is.Zero);
        }

        [Test]
        public void UnreachableLevelsAreRefusedWithThePartsOfTheSystemDelay()
        {
            var slow = new SystemDelay(13.9, 0.0, 21.3, 25.0);
            Assert.That(() => slow.CheckReaches(new[] { 50.0, 60.0, 70.0, 570.0 }), Throws.TypeOf<StudyException>().With
                .Message.Contains("level 50, 60, 570 ms cannot be reached").And
                .Message.Contains("60.2 ms (pose interval 13.9 + inference 0.0 + block 21.3 + device 25.0)").And
                .Message.Contains("levels_ms"));
            Assert.That(() => slow.CheckReaches(new[] { 70.0, 560.0 }), Throws.Nothing);
            Assert.That(() => slow.ArtificialMilliseconds(50.0), Throws.TypeOf<StudyException>());
        }

        [TestCase(double.NaN)]
        [TestCase(-1.0)]
        [TestCase(double.PositiveInfinity)]
        public void AnInvalidPartIsRefusedByName(double milliseconds) => Assert.That(
            () => new SystemDelay(1.0, 1.0, 1.0, milliseconds),
            Throws.TypeOf<StudyException>().With.Message.StartsWith("device_ms"));

        [Test]
        public void ALateFrameDoesNotChangeThePoseInterval()
        {
            var interval = new PoseInterval();
            for (int frame = 0; frame < 200; ++frame)
            {
                interval.Add(frame % 10 == 9 ? 0.5 : 1.0 / 72.0);
            }
            interval.Add(double.NaN);
            interval.Add(-3.0);
            interval.Add(1e9);
            Assert.That(interval.MedianMilliseconds, Is.EqualTo(1000.0 / 72.0).Within(1e-9));
        }
    }
}
