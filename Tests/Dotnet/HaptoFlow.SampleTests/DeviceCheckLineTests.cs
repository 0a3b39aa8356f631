using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.DeviceCheck;
using HaptoFlow.Numerics;
using HaptoFlow.Outputs;
using Newtonsoft.Json.Linq;
using NUnit.Framework;

namespace HaptoFlow.SampleTests
{
    /// <summary>Every line of the device check passes and fails on what it names; each failure says what to do.
    /// </summary>
    public sealed class DeviceCheckLineTests
    {
        [TestCase("native library")]
        [TestCase("struct sizes")]
        [TestCase("ONNX Runtime")]
        public void ALibraryThatThrowsFailsItsOwnLineWithItsMessage(string broken)
        {
            List<CheckLine> lines = Lines(Facts("").AddTo);
            Assert.That(lines.Select(line => line.State), Is.All.EqualTo(CheckState.Passed));
            Assert.That(Measured(lines, "native library"), Is.EqualTo("version 0.2.0"));
            lines = Lines(Facts(broken).AddTo);
            Assert.That(Failed(lines), Is.EqualTo(new[] { broken }));
            Assert.That(Measured(lines, broken), Is.EqualTo("it is broken"));

            static LibraryFacts Facts(string broken) => new LibraryFacts(
                Version: () => broken == "native library" ? throw new DllNotFoundException("it is broken") : "0.2.0",
                RequireAgreement: () => Throw(broken == "struct sizes"),
                OpenOnnxRuntime: () => Throw(broken == "ONNX Runtime"),
                Structs: 17);
        }

        [Test]
        public void AttributesFailWithoutRoutesSettingsOrCallback()
        {
            var good = new AttributeFacts(
                Routes: new[] { "XR impulse" }, ExpectsRoutes: true, HasModel: true, Callback: "reading");
            Passes(good.AddTo, 3);
            Fails(good, facts => facts with { Routes = Array.Empty<string>() }, "routes to devices");
            Fails(good, facts => facts with { HasModel = false }, "settings and model");
            Fails(good, facts => facts with { Callback = "" }, "callback from the library");
            // Where IL2CPP does not recognise the callback, it throws before learning begins.
            Fails(good, facts => facts with { Callback = "", CallbackProblem = "not supported" },
                "callback from the library");
            good = good with { Routes = Array.Empty<string>(), ExpectsRoutes = false, CallbackSkipped = "no model" };
            Assert.That(States(Lines(good.AddTo)), Is.EqualTo(new[]
            {
                CheckState.Skipped, CheckState.Passed, CheckState.Skipped,
            }));
        }

        [Test]
        public void AModelFailsWithAProblemTooSlowOrWithoutLabelsAndTiers()
        {
            var good = new ModelFacts(null, 0.4, new[] { "wood" }, new[] { "draft" });
            Passes(good.AddTo, 3);
            Fails(good, facts => facts with { Problem = "damaged" }, "loading");
            Fails(good, facts => facts with { Seconds = 10.1 }, "loading");
            Fails(good, facts => facts with { Labels = Array.Empty<string>() }, "labels");
            Fails(good, facts => facts with { Tiers = Array.Empty<string>() }, "tiers");
        }

        [Test]
        public void CallbacksFailWhenMissingSlowOrAllocating()
        {
            var good = new CallbackFacts(
                Milliseconds: Enumerable.Repeat(0.2f, 468).Append(5f).ToArray(), Blocks: 469, Seconds: 5.0,
                SampleRateHz: 48000, BlockFrames: 512, Bytes: 0);
            Passes(good.AddTo, 3);
            Assert.That(Measured(Lines(good.AddTo), "time for a block"),
                Is.EqualTo("median 0.200 ms, 99th percentile 0.200 ms, worst 5.000 ms, of 10.7 ms"));
            Fails(good, facts => facts with { Blocks = 400 }, "callbacks");
            Fails(good, facts => facts with { Milliseconds = facts.Milliseconds.SkipLast(1).Append(11f).ToArray() },
                "time for a block");
            Fails(good, facts => facts with { Milliseconds = Enumerable.Repeat(3f, 469).ToArray() },
                "time for a block");
            Fails(good, facts => facts with { Bytes = 24 }, "allocations");
            good = good with { Bytes = null };
            Assert.That(States(Lines(good.AddTo)).Last(), Is.EqualTo(CheckState.Skipped));
            good = good with { Blocks = 0, Milliseconds = Array.Empty<float>() };
            Assert.That(States(Lines(good.AddTo)), Is.EqualTo(new[]
            {
                CheckState.Failed, CheckState.Skipped, CheckState.Skipped,
            }));
        }

        [Test]
        public void TheEngineFailsWithADeadWorkerRefusedPrioritySlownessLatenessOrAFrameRateBelowTheDisplays()
        {
            var good = new EngineFacts(
                WorkerIsAlive: true, PriorityWasRefused: false, FailedRounds: 0, Failure: "", BudgetMs: 6.0, MedianMs: 1.0,
                Percentile99Ms: 2.0, Runs: 100, Segments: 100, Late: 1, FramesHz: 71.0, DisplayHz: 72.0);
            Passes(good.AddTo, 5);
            Fails(good, facts => facts with { WorkerIsAlive = false }, "worker");
            Fails(good, facts => facts with { FailedRounds = 1 }, "worker");
            Fails(good, facts => facts with { PriorityWasRefused = true }, "worker's priority");
            Fails(good, facts => facts with { Percentile99Ms = 6.1 }, "time for a segment");
            Fails(good, facts => facts with { Runs = 0 }, "time for a segment");
            Fails(good, facts => facts with { Late = 2 }, "late segments");
            Fails(good, facts => facts with { Segments = 0 }, "late segments");
            Fails(good, facts => facts with { FramesHz = 36.0 }, "display's rate");
            good = good with { DisplayHz = 0.0 };
            Assert.That(States(Lines(good.AddTo)).Last(), Is.EqualTo(CheckState.Skipped));
        }

        [Test]
        public void TheAudioDeviceFailsWithLongBlocksOddRatesOrSilenceAfterAChange()
        {
            var good = new ConfigurationFacts(
                SampleRateHz: 48000, BlockFrames: 512, WasAccepted: true, AskedFrames: 1024, NewFrames: 1024,
                BlocksAfter: 70, SegmentsAfter: 50);
            Passes(good.AddTo, 2);
            Fails(good, facts => facts with { BlockFrames = 2048 }, "configuration");
            Fails(good, facts => facts with { SampleRateHz = 384000 }, "configuration");
            Fails(good, facts => facts with { BlocksAfter = 0 }, "change of configuration");
            Fails(good, facts => facts with { SegmentsAfter = 0 }, "change of configuration");
            good = good with { WasAccepted = false };
            Assert.That(States(Lines(good.AddTo)).Last(), Is.EqualTo(CheckState.Skipped));
        }

        [Test]
        public void APauseFailsWithoutEngineBlocksOrSegmentsAfterwards()
        {
            var good = new PauseFacts(
                Happened: true, Seconds: 3.0, EngineIsReady: true, BlocksAfter: 70, SegmentsAfter: 50);
            Passes(good.AddTo, 1);
            Fails(good, facts => facts with { EngineIsReady = false }, "pause and resume");
            Fails(good, facts => facts with { BlocksAfter = 0 }, "pause and resume");
            Fails(good, facts => facts with { SegmentsAfter = 0 }, "pause and resume");
            Assert.That(States(Lines(new PauseFacts().AddTo)), Is.EqualTo(new[] { CheckState.Skipped }));
        }

        [TestCase(HapticForm.Waveform)]
        [TestCase(HapticForm.Parametric)]
        [TestCase(HapticForm.Amplitude)]
        public void ARouteFailsWithoutSubmissionsWithARefusalOrWithAGap(HapticForm form)
        {
            var good = new RouteFacts(
                Hand: "Right", Route: "a route", Form: form, Device: "a device", RateHz: 500.0,
                MaximumSamples: 256, Submissions: 30, Refused: 0, Gaps: 0);
            Passes(good.AddTo, 1);
            Assert.That(Lines(good.AddTo)[0].Measured, Does.StartWith(
                $"a device: {form.ToString().ToLowerInvariant()}, 500 Hz")
                .And.EndsWith("; 30 of 30 submissions accepted, 0 gaps"));
            const string Name = "Right hand, a route";
            Fails(good, facts => facts with { Submissions = 0 }, Name);
            Fails(good, facts => facts with { Refused = 1 }, Name);
            Fails(good, facts => facts with { Gaps = 1 }, Name);
            Assert.That(RouteFacts.None("Left").State, Is.EqualTo(CheckState.Skipped));
        }

        [Test]
        public void TipForceFailsWhenRestPressesOrPressureIsWeakOrConstant()
        {
            Assert.That(Failed(Stylus(0.01f, index => 0.01f * index, 0.0)), Is.Empty);
            Assert.That(Failed(Stylus(0.06f, index => 0.01f * index, 0.0)), Is.EqualTo(new[] { "pen at rest" }));
            Assert.That(Failed(Stylus(0.01f, index => 0.0009f * index, 0.0)), Is.EqualTo(new[] { "pen pressed" }));
            Assert.That(Failed(Stylus(0.01f, index => 1f, 0.0)), Is.EqualTo(new[] { "pen pressed" }));
            Assert.That(Stylus(null, index => null, 0.0)
                .Single(line => line.Group == "Tip force").State, Is.EqualTo(CheckState.Skipped));
        }

        [Test]
        public void TheNoiseOfTheForceIsItsStandardDeviation()
        {
            var probe = new StylusProbe("pen", 0.05);
            for (int frame = 0; frame < 100; ++frame)
            {
                probe.Add(false, 0.01, default(Double3), frame % 2 == 0 ? 0.01f : 0.03f);
            }
            Assert.That(Measured(Lines(lines => probe.AddTo(lines, 90.0)), "pen at rest"),
                Is.EqualTo("mean 0.020 N, noise 0.0100 N, largest 0.030 N; a touch begins at 0.050 N"));
        }

        [Test]
        public void TrackingFailsWithJitterRepeatedPosesOrDropouts()
        {
            Assert.That(Failed(Stylus(null, _ => null, 0.0004)), Is.Empty);
            Assert.That(Failed(Stylus(null, _ => null, 0.0006)), Is.EqualTo(new[] { "pen jitter" }));
            Assert.That(Measured(Stylus(null, _ => null, 0.0006), "pen jitter"), Does.StartWith("0.600 mm"));
            Assert.That(Failed(Stylus(null, _ => null, 0.0, repeats: 2)), Is.EqualTo(new[] { "pen rate" }));
            Assert.That(Failed(Stylus(null, _ => null, 0.0, lostEvery: 10)), Is.EqualTo(new[] { "pen rate" }));
            Assert.That(Lines(lines => new StylusProbe("pen", 0.05).AddTo(lines, 90.0))
                .Single(line => line.Group == "Tracking").State, Is.EqualTo(CheckState.Skipped));
        }

        [Test]
        public void BothFilesHoldEveryLineAndThePageNeedsNothingElse()
        {
            using var folder = new StudyFolder();
            var report = new DeviceCheckReport(new[] { ("device", "a <b> & \"c\"") });
            report.Lines.Add(CheckLine.Of("Engine", "worker", false, "<script>", "do this"));
            report.Lines.Add(CheckLine.Of("Engine", "late", true, "0 of 9", "never shown"));
            report.Lines.Add(CheckLine.Unanswered("Felt", "stop"));
            string page = File.ReadAllText(report.Write(folder.Path));
            // A second run replaces both files.
            report.Write(folder.Path);
            Assert.That(Directory.GetFiles(folder.Path).Select(Path.GetFileName), Is.EquivalentTo(new[]
            {
                DeviceCheckReport.JsonName, DeviceCheckReport.PageName,
            }));
            Assert.That(report.Summary, Is.EqualTo("1 passed, 1 failed, 0 skipped, 1 not answered"));
            Assert.That(page, Does.Contain("&lt;script&gt;").And.Contain("a &lt;b&gt; &amp; &quot;c&quot;")
                .And.Contain("do this").And.Contain(report.Summary).And.Not.Contain("<script"));
            Assert.That(page, Does.Not.Contain("never shown").And.Not.Contain("http").And.Not.Contain("src="));
            JObject json = JObject.Parse(File.ReadAllText(Path.Combine(folder.Path, DeviceCheckReport.JsonName)));
            Assert.That(json["lines"]!.Select(line => (string)line["state"]!), Is.EqualTo(new[]
            {
                "failed", "passed", "asked",
            }));
            Assert.That((string)json["environment"]!["device"]!, Is.EqualTo("a <b> & \"c\""));
            Assert.That((string)json["lines"]![0]!["remedy"]!, Is.EqualTo("do this"));
        }

        [Test]
        public void ThePageNamesThePublishedTrackerOnceThereIsOne()
        {
            const string Address = "https://tracker.example";
            Assert.That(DeviceCheckReport.WhereToSendTo(Address), Does.Contain(Address));
            Assert.That(DeviceCheckReport.WhereToSendTo(""), Does.Contain("repository that you have the package from"));
        }

        /// <summary>The change makes exactly one line fail, and that line says what to do.</summary>
        private static void Fails<TFacts>(TFacts good, Func<TFacts, TFacts> change, string name)
            where TFacts : Facts => Assert.That(Failed(Lines(change(good).AddTo)), Is.EqualTo(new[] { name }));

        private static void Passes(Action<List<CheckLine>> add, int count) => Assert.That(States(Lines(add)),
            Is.EqualTo(Enumerable.Repeat(CheckState.Passed, count)));

        private static List<CheckLine> Lines(Action<List<CheckLine>> add)
        {
            var lines = new List<CheckLine>();
            add(lines);
            return lines;
        }

        private static IEnumerable<CheckState> States(List<CheckLine> lines) => lines.Select(line => line.State);

        private static string[] Failed(List<CheckLine> lines)
        {
            foreach (CheckLine line in lines)
            {
                Assert.That(line.Remedy.Length > 0, Is.EqualTo(line.State == CheckState.Failed), line.Name);
                Assert.That(line.Measured, Is.Not.Empty, line.Name);
            }
            return lines.Where(line => line.State == CheckState.Failed).Select(line => line.Name).ToArray();
        }

        private static string Measured(List<CheckLine> lines, string name) =>
            lines.Single(line => line.Name == name).Measured;

        private static void Throw(bool really)
        {
            if (really)
            {
                throw new InvalidOperationException("it is broken");
            }
        }

        /// <summary>A second at rest and a second of a stroke, at 90 frames a second.</summary>
        private static List<CheckLine> Stylus(float? rest, Func<int, float?> pressed, double jitterMetres,
            int repeats = 1, int lostEvery = int.MaxValue)
        {
            var probe = new StylusProbe("pen", 0.05);
            for (int frame = 0; frame < 90; ++frame)
            {
                double x = frame % 2 == 0 ? jitterMetres : -jitterMetres;
                probe.Add(false, 1.0 / 90.0, new Double3(x, 0.0, 0.0), rest);
            }
            for (int frame = 0; frame < 90; ++frame)
            {
                bool isLost = frame % lostEvery == lostEvery - 1;
                probe.Add(true, 1.0 / 90.0, isLost ? (Double3?)null : new Double3(0.001 * (frame / repeats), 0.0, 0.0),
                    pressed(frame));
            }
            return Lines(lines => probe.AddTo(lines, 90.0));
        }
    }
}
