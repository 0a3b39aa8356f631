using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Samples.SimilarityStudy;
using HaptoFlow.Studies;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>The procedure of the similarity study, trial by trial.</summary>
    public sealed class SimilarityProcedureTests : SimilarityTest
    {
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
            IEnumerable<string> seen = FindAll<TextMesh>().Select(each => each.text)
                .Concat(FindAll<Transform>().Select(each => each.name));
            foreach (string text in seen)
            {
                Assert.That(words.Where(word => text.Contains(word, StringComparison.OrdinalIgnoreCase)), Is.Empty,
                    text);
            }
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
