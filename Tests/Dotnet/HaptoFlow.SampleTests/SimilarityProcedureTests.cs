using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using HaptoFlow.Samples.SimilarityStudy;
using HaptoFlow.Studies;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    public sealed class SimilarityProcedureTests : SimilarityTest
    {
        [TestCase(6, 4)]
        [TestCase(1, 2)]
        public void AnInterruptedSessionLogsEveryTrialExactlyOnce(int materials, int methods)
        {
            // The settings of the project have no model.
            HaptoFlowSettings.Active.Model = null;
            SimilarityStudySettings settings = Settings(materials, methods);
            settings.Simulated = true;
            inference = new Dictionary<string, double> { ["Ours"] = 9.5, ["Rival"] = 14.25 };
            Begin(settings);
            StudyPlan plan = scene.Session!.Plan;
            Assert.That(plan.Trials, Has.Count.EqualTo(methods + materials * methods));
            int stopAt = methods + materials * methods / 2;
            List<StudyPause> pauses = TakePart(stopAt);
            Crash();
            Begin(settings);
            Assert.That((scene.Session!.Trial!.Trial, scene.Session.Attempt), Is.EqualTo((stopAt, 2)));
            Assert.That(scene.Session.Plan.Seed, Is.EqualTo(plan.Seed));
            pauses.AddRange(TakePart());
            int rests = 1 + (materials * methods - 1) / 12;
            Assert.That(pauses.Count(pause => pause == StudyPause.Rest), Is.EqualTo(rests));
            Assert.That(pauses.Count(pause => pause == StudyPause.Begin), Is.EqualTo(2));
            // Every change of the material is a pause, unless a rest or the interruption comes first.
            int changes = Enumerable.Range(1, plan.Trials.Count - 1).Count(next => !plan.Trials[next].RestBefore &&
                plan.Trials[next].Trial != stopAt && plan.Trials[next].Material != plan.Trials[next - 1].Material);
            Assert.That(pauses.Count(pause => pause == StudyPause.Sample), Is.EqualTo(changes));

            List<Dictionary<string, string>> rows = Rows();
            Assert.That(rows.Select(row => int.Parse(row["trial"], CultureInfo.InvariantCulture)),
                Is.EqualTo(Enumerable.Range(1, plan.Trials.Count)));
            foreach ((Dictionary<string, string> row, PlannedTrial trial) in
                rows.Zip(plan.Trials, (row, trial) => (row, trial)))
            {
                string where = $"trial {trial.Trial}";
                Assert.That((row["block"], row["material"], row["method"]),
                    Is.EqualTo((trial.Block, trial.Material, trial.Method)), where);
                Assert.That(row["rating"], Is.EqualTo($"{RatingOf(trial)}"), where);
                Assert.That(row["attempt"], Is.EqualTo(trial.Trial == stopAt ? "2" : "1"), where);
                Assert.That(Number(row, "delivered_delay_ms"), Is.EqualTo(Number(row, "delay_ms")), where);
                Assert.That(Number(row, "system_delay_ms") + Number(row, "artificial_delay_ms"),
                    Is.EqualTo(Number(row, "delay_ms")).Within(1e-5), where);
                foreach (string column in new[] { "real_edges_seconds", "virtual_edges_seconds", "free_seconds",
                    "response_seconds", "contact_seconds", "path_mm", "mean_speed_mmps", "mean_force_newtons" })
                {
                    Assert.That(Number(row, column), Is.GreaterThan(0.0), $"{where}, {column}");
                }
                // Only the path on the virtual object counts: its perimeter of 0.676 m and a stroke of 0.12 m.
                Assert.That(Number(row, "path_mm"), Is.InRange(650.0, 850.0), where);
                Assert.That(row["underruns"], Is.EqualTo("0"), where);
            }
            Assert.That(rows.Select(row => row["delay_ms"]).Distinct().Count(), Is.EqualTo(1));
            Assert.That(rows.Select(row => Number(row, "elapsed_seconds")), Is.Ordered.Ascending);
            string sidecar = File.ReadAllText(Path.ChangeExtension(Csv, ".json"));
            Assert.That(sidecar, Does.Contain("\"finished\": true").Or.Contain("\"finished\":true"));
            Assert.That(sidecar, Does.Match("\"resumptions\": ?1").And.Match("\"simulated\": ?true"));
            foreach (StudyMethod method in settings.methods)
            {
                using var sha256 = System.Security.Cryptography.SHA256.Create();
                string hash = BitConverter.ToString(sha256.ComputeHash(method.model!.File)).Replace("-", "");
                Assert.That(sidecar, Does.Contain(hash.ToLowerInvariant()));
                Assert.That(sidecar, Does.Contain(method.model.name + ".haptoflow"));
            }
            Assert.That(Directory.GetFiles(folder), Has.Length.EqualTo(2));
            Assert.That(Log.Lines.Where(line => line.Type != LogType.Log), Is.Empty);
            if (materials == 6)
            {
                RecordedSession.Keep(folder, "similarity");
            }
        }

        [Test]
        public void AFailingModelPausesTheSessionAndNamesTheMethod()
        {
            Begin(Settings(1, 2));
            scene.Session!.Continue();
            TraceReal();
            scene.Models!.Of(scene.Session.Trial!.Method!).Dispose();
            World.Frames(2);
            Assert.That(scene.Session.Phase, Is.EqualTo(StudyPhase.Paused));
            Assert.That(scene.Problem, Does.Contain("method \"Ours quick\": the model was closed"));
            Assert.That((Procedure.Stage, scene.Output.Muted), Is.EqualTo((TrialStage.Waiting, true)));
        }

        [Test]
        public void APauseForANewSampleMutesTheOutputAndClosesTheQuestion()
        {
            Begin(Settings(2, 2));
            while (scene.Session!.Pause != StudyPause.Sample || scene.Session.Phase != StudyPhase.Paused)
            {
                scene.Session.Continue();
                TraceReal();
                TraceVirtual();
                Answer(4);
            }
            PlannedTrial next = scene.Session.Trial!;
            Assert.That(next.ChangesSample, Is.True);
            PlayFor(0.3);
            Assert.That(scene.Operator.Lines, Has.Some.Contains("another sample: mount it"));
            Assert.That(scene.Operator.Lines, Has.Some.Contains($"mount the sample \"{next.Material}\""));
            AudioDevice.Forget();
            TraceReal();
            TraceVirtual();
            Answer(4);
            Assert.That((Procedure.Stage, LoudestFelt()), Is.EqualTo((TrialStage.Waiting, 0f)));
            scene.Session.Continue();
            Assert.That((scene.Session.Trial, scene.Session.Attempt), Is.EqualTo((next, 1)));
        }

        [Test]
        public void TheOutputIsMutedOnTheRealSampleAndPlaysOnTheVirtualObject()
        {
            Begin(Settings(2, 2));
            scene.Session!.Continue();
            AudioDevice.Forget();
            TraceReal();
            Assert.That(LoudestFelt(), Is.Zero, "the real sample, edges");
            ulong inferred = scene.Pen.TryGetStatistics(out VoiceStatistics voice) ? voice.Inferences : 0;
            Assert.That(inferred, Is.Zero);
            AudioDevice.Forget();
            TraceVirtual();
            Assert.That(LoudestFelt(), Is.GreaterThan(Audible), "the virtual object, edges");
            PlayFor(0.2);
            AudioDevice.Forget();
            Slide(Corner(scene.Real.Frame, 0), Corner(scene.Real.Frame, 2));
            Assert.That(LoudestFelt(), Is.Zero, "the real sample, freely");
            AudioDevice.Forget();
            Slide(Corner(scene.Virtual.Frame, 0), Corner(scene.Virtual.Frame, 2));
            Assert.That(LoudestFelt(), Is.GreaterThan(Audible), "the virtual object, freely");
        }

        [Test]
        public void ATrialContinuesOnlyAfterAllFourEdgesAreTraced()
        {
            Begin(Settings(1, 2));
            scene.Session!.Continue();
            Trace(scene.Real.Frame, 3);
            Trace(scene.Real.Frame, 3);
            Assert.That(Procedure.Stage, Is.EqualTo(TrialStage.RealEdges));
            Trace(scene.Real.Frame, 4, 0.02f);
            Assert.That(Procedure.Stage, Is.EqualTo(TrialStage.RealEdges), "edges in the air are not traced");
            TraceVirtual();
            Assert.That(Procedure.Stage, Is.EqualTo(TrialStage.RealEdges), "the edges of the other object do not count");
            Answer(4);
            Assert.That(scene.Panel.IsOpen, Is.False);
            TraceReal();
            Trace(scene.Virtual.Frame, 3);
            Assert.That(Procedure.Stage, Is.EqualTo(TrialStage.VirtualEdges));
            Answer(4);
            Assert.That((scene.Session.Phase, scene.Session.Trial!.Trial), Is.EqualTo((StudyPhase.Task, 1)));
            TraceVirtual();
            Assert.That((Procedure.Stage, scene.Panel.IsOpen), Is.EqualTo((TrialStage.Free, true)));
            Assert.That(Rows(), Is.Empty);
        }

        [Test]
        public void AConfirmedAnswerCountsOnce()
        {
            Begin(Settings(1, 2));
            scene.Session!.Continue();
            TraceReal();
            TraceVirtual();
            Press(Left + "triggerPressed");
            Assert.That(scene.Panel.IsOpen, Is.True, "nothing was chosen");
            Press(Left + "secondaryButton");
            Assert.That(scene.Panel.Choice, Is.EqualTo(4));
            Press(Left + "secondaryButton");
            Press(Left + "secondaryButton");
            Press(Left + "primaryButton");
            Assert.That(scene.Panel.Choice, Is.EqualTo(5));
            Press("<Keyboard>/7");
            Press(Left + "secondaryButton");
            Assert.That(scene.Panel.Choice, Is.EqualTo(7));
            SimulatedInput.SetControl(Left + "triggerPressed", 1f);
            SimulatedInput.SetControl("<Keyboard>/enter", 1f);
            World.Frames(20);
            Assert.That(Rows().Single()["rating"], Is.EqualTo("7"));
            scene.Panel.Confirm();
            scene.Panel.Choose(3);
            Assert.That((Rows().Count, scene.Panel.Choice), Is.EqualTo((1, (int?)7)));
        }

        [Test]
        public void AButtonHeldWhileTheQuestionOpensIsIgnored()
        {
            Begin(Settings(1, 2));
            scene.Session!.Continue();
            TraceReal();
            SimulatedInput.SetControl("<Keyboard>/2", 1f);
            SimulatedInput.SetControl(Left + "triggerPressed", 1f);
            TraceVirtual();
            World.Frames(5);
            Assert.That((scene.Panel.IsOpen, scene.Panel.Choice), Is.EqualTo((true, (int?)null)));
        }

        [Test]
        public void NothingVisibleRevealsMaterialOrMethod()
        {
            SimilarityStudySettings settings = Settings(3, 4);
            string[] words = settings.materials.SelectMany(each => new[] { each.name, each.label })
                .Concat(settings.methods.SelectMany(each => new[] { each.name, each.model!.name, $"{each.Quality}" }))
                .ToArray();
            Begin(settings);
            var looks = new HashSet<string>();
            while (scene.Session!.Phase != StudyPhase.Finished)
            {
                scene.Session.Continue();
                looks.Add(LooksOf(words));
                if (scene.Session.Phase == StudyPhase.Task)
                {
                    TraceReal();
                    looks.Add(LooksOf(words));
                    TraceVirtual();
                    looks.Add(LooksOf(words));
                    Answer(1);
                }
            }
            Assert.That(looks, Has.Count.EqualTo(1));
        }

        /// <summary>Checks that both objects have the same colour and size, and that no text or name reveals anything.
        /// </summary>
        private string LooksOf(string[] words)
        {
            IEnumerable<string> seen = All<TextMesh>().Select(each => each.text)
                .Concat(All<Transform>().Select(each => each.name));
            Assert.That(seen.Where(text => words.Any(word => text.Contains(word, StringComparison.OrdinalIgnoreCase))),
                Is.Empty);
            string Look(StudyObject each) => $"{each.Renderer.material.color} {each.Renderer.material.mainTexture} " +
                $"{each.Renderer.transform.lossyScale}";
            Assert.That(Look(scene.Virtual), Is.EqualTo(Look(scene.Real)));
            return Look(scene.Real);
        }
    }

    /// <summary>Tracing of a rectangle of 20 x 15 cm with a tolerance of 1 cm.</summary>
    public sealed class EdgeTracingTests
    {
        private EdgeTracing tracing = null!;

        [SetUp]
        public void Begin() => tracing = new EdgeTracing(0.2, 0.15, 0.01, 0.9);

        [Test]
        public void TracingAllEdgesInAnyOrderCompletesTheRectangle()
        {
            Line(0.1, 0.075, 0.1, -0.075);
            Line(-0.1, 0.075, 0.1, 0.075);
            Line(0.1, -0.075, -0.1, -0.075);
            Assert.That((tracing.TracedEdges, tracing.IsComplete), Is.EqualTo((3, false)));
            Line(-0.1, -0.075, -0.1, 0.075);
            Assert.That(tracing.IsComplete, Is.True);
        }

        [TestCase(0.85, false)]
        [TestCase(0.95, true)]
        public void AnEdgeIsTracedWhenItsRequiredShareIsCovered(double share, bool isTraced)
        {
            Line(-0.1, -0.075, -0.1 + 0.2 * share, -0.075);
            Assert.That(tracing.IsTraced(0), Is.EqualTo(isTraced));
        }

        [Test]
        public void ALineBesideAnEdgeAndPositionsThatAreNoNumbersTraceNothing()
        {
            Line(-0.09, -0.06, 0.09, -0.06);
            Line(-0.09, 0.0, 0.09, 0.0);
            tracing.Add(double.NaN, double.NaN);
            tracing.Add(double.PositiveInfinity, 0.0);
            Assert.That(tracing.TracedEdges, Is.Zero);
        }

        [TestCase(0.04, false, true, Description = "positions of a fast hand are connected")]
        [TestCase(0.04, true, false, Description = "parts passed while lifted are not traced")]
        [TestCase(0.2, false, false, Description = "a jump along an edge traces nothing between")]
        public void TouchingPositionsAreConnectedUpToTheStepOfAFastHand(double step, bool lifts, bool isTraced)
        {
            for (double x = -0.1; x <= 0.1001; x += step)
            {
                tracing.Add(x, -0.075);
                if (lifts)
                {
                    tracing.Lift();
                }
            }
            Assert.That(tracing.IsTraced(0), Is.EqualTo(isTraced));
        }

        [Test]
        public void StartingAnewClearsTheTracedEdges()
        {
            Line(-0.1, -0.075, 0.1, -0.075);
            tracing.Begin();
            Assert.That(tracing.TracedEdges, Is.Zero);
        }

        private void Line(double fromX, double fromZ, double toX, double toZ)
        {
            tracing.Lift();
            for (int step = 0; step <= 50; ++step)
            {
                double share = step / 50.0;
                tracing.Add(fromX + share * (toX - fromX), fromZ + share * (toZ - fromZ));
            }
        }
    }
}
