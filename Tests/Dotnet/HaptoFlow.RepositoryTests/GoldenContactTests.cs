using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.Contact;
using HaptoFlow.Model;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    public sealed class GoldenContactTests
    {
        private const double Tolerance = 1e-5;

        private static readonly Lazy<JsonValue> File = new Lazy<JsonValue>(() =>
            JsonValue.Parse(System.IO.File.ReadAllText(RepositoryFiles.In("Tests", "Golden", "contact", "contact-states.json"))));

        private static IEnumerable<string> CaseNames() =>
            File.Value["cases"].AsArray().Select(testCase => testCase["name"].AsText());

        [Test]
        public void TheGoldenFileContainsCases()
        {
            Assert.That(File.Value["format"].AsText(), Is.EqualTo("haptoflow contact states"));
            Assert.That(File.Value["version"].AsInteger(), Is.EqualTo(2));
            Assert.That(CaseNames().Count(), Is.GreaterThanOrEqualTo(8));
        }

        [TestCaseSource(nameof(CaseNames))]
        public void ContactStatesAgreeWithTheNativeContactModel(string name)
        {
            JsonValue testCase = File.Value["cases"].AsArray().Single(each => each["name"].AsText() == name);
            var scene = new GoldenScene(testCase);
            IReadOnlyList<JsonValue> samples = testCase["stroke"]["samples"].AsArray();
            IReadOnlyList<JsonValue> readings = testCase["expected"]["readings"].AsArray();
            Assert.That(readings.Count, Is.EqualTo(samples.Count).And.GreaterThan(10));
            for (int frame = 0; frame < samples.Count; ++frame)
            {
                Compare(scene, testCase["expected"]["columns"], scene.Play(frame), readings[frame], frame);
            }
            CompareStatistics(scene.Tracker.Statistics, testCase["statistics"]);
        }

        private static void Compare(
            GoldenScene scene, JsonValue columns, in ContactReading reading, JsonValue expected, int frame)
        {
            for (int column = 0; column < columns.AsArray().Count; ++column)
            {
                string name = columns[column].AsText();
                Assert.That(scene.ValueOf(reading, name), Is.EqualTo(expected[column].AsNumber()).Within(Tolerance),
                    $"{name} of frame {frame}");
            }
        }

        private static void CompareStatistics(in ContactStatistics statistics, JsonValue expected)
        {
            Assert.That(statistics.Samples, Is.EqualTo((ulong)expected["samples"].AsInteger()));
            Assert.That(statistics.SanitisedSamples, Is.EqualTo((ulong)expected["sanitised_samples"].AsInteger()));
            Assert.That(statistics.Teleports, Is.EqualTo((ulong)expected["teleports"].AsInteger()));
            Assert.That(statistics.ClockRestarts, Is.EqualTo((ulong)expected["clock_restarts"].AsInteger()));
            Assert.That(statistics.TouchDowns, Is.EqualTo((ulong)expected["touch_downs"].AsInteger()));
        }
    }
}
