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
    /// <summary>The output of a trial: its model, its material, its delay.</summary>
    public sealed class SimilaritySoundTests : SimilarityTest
    {
        private const int OutputHz = 48000;
        private const int BlockFrames = 512;

        [Test]
        public void EveryTrialUsesOnlyThePlannedModelAndTier()
        {
            Begin(Settings(2, 4));
            int trials = 0;
            while (scene.Session!.Phase != StudyPhase.Finished)
            {
                scene.Session.Continue();
                if (scene.Session.Phase != StudyPhase.Task)
                {
                    continue;
                }
                PlannedTrial trial = scene.Session.Trial!;
                TraceReal();
                HapticEngine before = HapticSession.Current.Engine!;
                ulong segments = before.Statistics().Segments;
                TraceVirtual();
                HapticLoadedModel planned = scene.Models!.Of(trial.Method!);
                StudyMethod method = scene.Settings!.methods.Single(each => each.name == trial.Method);
                Assert.That(planned.IsInUse, Is.True, $"trial {trial.Trial}");
                Assert.That(planned.Model, Is.SameAs(method.model));
                Assert.That(planned.TierName, Is.EqualTo(method.Quality == HapticQuality.Draft ? "draft" : "standard"));
                Assert.That(HapticSession.Current.Engine, Is.SameAs(before));
                Assert.That(before.Statistics().Segments, Is.GreaterThan(segments), $"trial {trial.Trial}");
                StudyMaterial material = scene.Settings.materials.Single(each => each.name == trial.Material);
                Assert.That(scene.Pen.Contact.Material!.Label, Is.EqualTo(material.label));
                Assert.That(scene.Virtual.Surface.SharedDescription.Effects, Is.EqualTo(HapticEffects.Texture));
                Answer(4);
                ++trials;
            }
            Assert.That(trials, Is.EqualTo(4 + 8));
        }

        [Test]
        public void EveryMethodIsDelayedToTheSlowestOne()
        {
            inference = new Dictionary<string, double> { ["Ours quick"] = 3.0, ["Rival quick"] = 33.0 };
            // One audio block per frame, so that a touch comes at the same position of a block in every trial.
            World.FrameRateHz = OutputHz / (double)BlockFrames;
            Begin(Settings(1, 2));
            var onset = new Dictionary<string, double>();
            var artificial = new Dictionary<string, double>();
            double block = 1000.0 * BlockFrames / OutputHz;
            while (scene.Session!.Phase != StudyPhase.Finished)
            {
                scene.Session.Continue();
                if (scene.Session.Phase != StudyPhase.Task)
                {
                    continue;
                }
                string method = scene.Session.Trial!.Method!;
                TraceReal();
                TraceVirtual();
                onset[method] = OnsetMilliseconds();
                float set = scene.Output.Processing.DelayMilliseconds;
                Answer(4);
                Dictionary<string, string> row = Rows().Last();
                artificial[method] = Number(row, "artificial_delay_ms");
                double system = Number(row, "system_delay_ms");
                // The sum of frame, method, block, and the device delay of 20 ms in the settings.
                Assert.That(system, Is.EqualTo(block + inference[method] + block + 20.0).Within(0.1));
                Assert.That(Number(row, "delay_ms"), Is.EqualTo(Math.Ceiling(2.0 * block + 33.0 + 20.0 + 2.0)));
                Assert.That(set, Is.EqualTo(artificial[method]).Within(1e-3));
            }
            Assert.That(artificial["Ours quick"] - artificial["Rival quick"], Is.EqualTo(30.0).Within(0.01));
            Assert.That(onset["Ours quick"] - onset["Rival quick"], Is.EqualTo(30.0).Within(1.5));
            Assert.That(artificial["Rival quick"], Is.InRange(EqualDelay.ReserveMilliseconds,
                EqualDelay.ReserveMilliseconds + 1.0));
        }

        [Test]
        public void EveryMethodIsMeasuredLiveByDefault()
        {
            measure = null;
            TryToBegin(Settings(1, 1));
            foreach (StudyMethod method in scene.Settings!.methods)
            {
                Assert.That(scene.Models!.InferenceMilliseconds(method.name), Is.GreaterThan(0.0), method.name);
            }
            double slowest = scene.Settings.methods.Max(each => scene.Delay!.Of(each.name).TotalMilliseconds);
            Assert.That(scene.Delay!.Milliseconds, Is.InRange(slowest + 2.0, slowest + 3.0));
        }

        /// <summary>The time from the frame of a touch-down to the first vibration.</summary>
        private double OnsetMilliseconds()
        {
            Vector3 place = Corner(scene.Virtual.Frame, 0);
            Vector3 down = 0.001f * Vector3.up;
            Hold(place + 0.02f * Vector3.up);
            PlayFor(0.3);
            AudioDevice.Forget();
            for (int frame = 0; frame < 20; ++frame)
            {
                Hold(place + down + 0.004f * (frame + 1) * Vector3.right);
            }
            Hold(place + 0.05f * Vector3.up);
            int first = Enumerable.Range(0, AudioDevice.RecordedFrames)
                .First(frame => Math.Abs(AudioDevice.Sample(frame, scene.Output.Channel)) > 0f);
            return 1000.0 * first / OutputHz;
        }
    }

    /// <summary>Alignment with a real sample that is lower than in the scene, and rotated.</summary>
    public sealed class SimilarityAlignmentTests : SimilarityTest
    {
        private readonly Vector3 place = new Vector3(0.04f, -0.05f, 0.03f);
        private readonly Quaternion turn = Quaternion.AngleAxis(9f, Vector3.up);
        private SimilarityStudySettings settings = null!;

        [SetUp]
        public void OpenUnaligned()
        {
            settings = Settings(1, 2);
            settings.needsAlignment = true;
            Open(settings, "similarity test " + Guid.NewGuid());
            SimulatedInput.SetControl(Right + "tip", 0f);
            WaitUntil(() => scene.Models?.IsReady == true);
            PlayFor(1.0);
        }

        [TearDown]
        public void DeleteTheSavedPlace() => scene.Alignment.Alignment.ForgetSaved();

        [Test]
        public void TheStudyDoesNotBeginBeforeThreePointsAreTouched()
        {
            scene.Begin(7);
            Assert.That((scene.CanBegin, scene.Session), Is.EqualTo((false, (StudySession?)null)));
            PlayFor(0.3);
            Assert.That(scene.Operator.Lines, Has.Some.Contains("press Align"));
            Assert.That(scene.Problem, Does.Contain("press Align"));
        }

        [Test]
        public void ThreeTouchedCornersAlignBothObjectsAndTheStudyRuns()
        {
            Align();
            Assert.That(scene.Alignment.Text, Does.StartWith("Aligned; 0."));
            Assert.That(Vector3.Distance(scene.Real.Frame.position, place), Is.LessThan(1e-3f));
            Vector3 aside = place + turn * settings.virtualMetres;
            Assert.That(Vector3.Distance(scene.Virtual.Frame.position, aside), Is.LessThan(1e-3f));
            Assert.That(scene.Pen.TouchBy, Is.EqualTo(TouchDecision.MeasuredForce));
            scene.Begin(7);
            scene.Session!.Continue();
            SimulatedInput.SetControl(Right + "tip", 0.5f);
            AudioDevice.Forget();
            Trace(scene.Real.Frame, 4, 0.001f);
            Assert.That((Procedure.Stage, LoudestFelt()), Is.EqualTo((TrialStage.VirtualEdges, 0f)));
            AudioDevice.Forget();
            Trace(scene.Virtual.Frame, 4, 0.001f);
            Assert.That(Procedure.Stage, Is.EqualTo(TrialStage.Free));
            Assert.That(LoudestFelt(), Is.GreaterThan(Audible));
            Answer(3);
            Assert.That(Rows().Single()["rating"], Is.EqualTo("3"));
        }

        [Test]
        public void AnAlignedPenThatDoesNotPressTracesNothing()
        {
            Align();
            scene.Begin(7);
            scene.Session!.Continue();
            SimulatedInput.SetControl(Right + "tip", 0f);
            Trace(scene.Real.Frame, 4);
            Assert.That(Procedure.Stage, Is.EqualTo(TrialStage.RealEdges));
        }

        [Test]
        public void TheOperatorTakesAndRemovesPointsForAPenWithoutForce()
        {
            scene.Alignment.Begin();
            foreach (Vector3 corner in Corners())
            {
                Hold(corner + scene.Pen.TipRadiusMetres * Vector3.up);
                scene.Alignment.TakePoint();
            }
            Assert.That(scene.Alignment.Alignment.IsAligned, Is.True);
            scene.Alignment.TakePoint();
            scene.Alignment.Alignment.Undo();
            Assert.That((scene.Alignment.Alignment.IsAligned, scene.CanBegin), Is.EqualTo((false, false)));
        }


        private void Align()
        {
            scene.Alignment.Begin();
            foreach (Vector3 corner in Corners())
            {
                Rest(corner + 0.05f * Vector3.up, 0f, 0.1);
                Rest(corner + scene.Pen.TipRadiusMetres * Vector3.up, 0.5f, 0.6);
                Rest(corner + 0.05f * Vector3.up, 0f, 0.1);
            }
        }

        private Vector3[] Corners()
        {
            Vector3 half = 0.5f * settings.sampleMetres;
            return new[] { new Vector3(-half.x, 0f, -half.z), new Vector3(half.x, 0f, -half.z),
                new Vector3(-half.x, 0f, half.z) }.Select(each => place + turn * each).ToArray();
        }

        private void Rest(Vector3 at, float pressure, double seconds)
        {
            SimulatedInput.SetControl(Right + "tip", pressure);
            for (int frame = 0; frame < seconds * World.FrameRateHz; ++frame)
            {
                Hold(at);
            }
        }
    }
}
