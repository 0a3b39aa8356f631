using System;
using System.Linq;
using HaptoFlow.Samples.SimilarityStudy;
using HaptoFlow.Studies;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
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
            PrepareWithoutAlignment();
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
            Vector3[] corners = Corners();
            foreach (Vector3 corner in corners)
            {
                Hold(corner + scene.Pen.TipRadiusMetres * Vector3.up);
                scene.Alignment.TakePoint();
            }
            Assert.That(scene.Alignment.Alignment.IsAligned, Is.True);
            scene.Alignment.TakePoint();
            scene.Alignment.Alignment.Undo();
            Assert.That((scene.Alignment.Alignment.IsAligned, scene.CanBegin), Is.EqualTo((false, false)));
        }

        /// <summary>Waits until everything but the alignment is ready.</summary>
        private void PrepareWithoutAlignment()
        {
            var until = DateTime.UtcNow.AddMinutes(2);
            while (scene.Models?.IsReady != true && DateTime.UtcNow < until)
            {
                World.Frame();
            }
            PlayFor(1.0);
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
