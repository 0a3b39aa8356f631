using System;
using System.Linq;
using HaptoFlow.SampleScenes;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>Alignment of the tracing sample's table with a real one, which is 4 cm lower and rotated.</summary>
    public sealed class AlignmentStepTests : SampleTest
    {
        private const string Right = "<XRController>{RightHand}/";
        private static readonly Vector3[] Paper =
        {
            new Vector3(-0.1485f, 0f, -0.255f), new Vector3(0.1485f, 0f, -0.255f), new Vector3(-0.1485f, 0f, -0.045f),
        };

        private readonly Vector3 deskPosition = new Vector3(0.05f, -0.04f, 0.02f);
        private readonly Quaternion deskRotation = Quaternion.AngleAxis(12f, Vector3.up);

        [SetUp]
        public void BuildScene()
        {
            FinishLoading();
            Camera camera = CameraOf(new SceneFile("StylusTracing"));
            Wake<TracingScene>(bootstrap =>
                (bootstrap.View, bootstrap.SaveName) = (camera, "sample test " + Guid.NewGuid()));
        }

        [TearDown]
        public void DeleteTheSavedPose() => Step().Alignment.ForgetSaved();

        [Test]
        public void ThreeTouchedCornersMoveTheTableToThePaperAndTheForceDecidesTouches()
        {
            Hover(0);
            Press("<Keyboard>/a");
            Assert.That(Step().Text, Does.Contain("near left"));
            Assert.That(Marks().Count(mark => mark.activeSelf), Is.EqualTo(1));
            for (int corner = 0; corner < 3; ++corner)
            {
                Rest(corner);
            }
            Assert.That(Step().Text, Does.StartWith("Aligned; 0."));
            Assert.That(Marks().Count(mark => mark.activeSelf), Is.Zero);
            Transform exhibits = Step().transform;
            Assert.That(Vector3.Distance(exhibits.position, deskPosition), Is.LessThan(1e-3f));
            Assert.That(Pen().TouchBy, Is.EqualTo(TouchDecision.MeasuredForce));
            // The pen presses the desk while it is tracked 6 mm too high, and then is in the air at the same place.
            Tip(new Vector3(0f, 0.006f, 0.02f), 0.5f);
            PlayFor(0.2);
            Assert.That(Pen().IsTouching, Is.True);
            Assert.That(Pen().Contact.Material!.Label, Is.EqualTo("wood"));
            Tip(new Vector3(0f, 0.006f, 0.02f), 0f);
            PlayFor(0.1);
            Assert.That(Pen().IsTouching, Is.False);
        }

        [Test]
        public void UndoRemovesThePointsAndThenTheAlignment()
        {
            Hover(0);
            Press("<XRController>{LeftHand}/primaryButton");
            Rest(0);
            Assert.That(Step().Alignment.PointsTaken, Is.EqualTo(1));
            Press("<XRController>{LeftHand}/secondaryButton");
            Assert.That(Step().Alignment.PointsTaken, Is.Zero);
            for (int corner = 0; corner < 3; ++corner)
            {
                Rest(corner);
            }
            Press("<Keyboard>/u");
            Assert.That(Step().transform.position.magnitude, Is.LessThan(1e-6f));
            Assert.That(Pen().TouchBy, Is.EqualTo(TouchDecision.Geometry));
        }

        private void Hover(int corner)
        {
            Tip(Paper[corner] + new Vector3(0f, 0.05f, 0f), 0f);
            PlayFor(0.1);
        }

        private void Rest(int corner)
        {
            Hover(corner);
            Tip(Paper[corner] + new Vector3(0f, Pen().TipRadiusMetres, 0f), 0.5f);
            PlayFor(0.6);
            Hover(corner);
        }

        /// <summary>Moves the pen's tip to a place on the real desk.</summary>
        private void Tip(Vector3 onDesk, float pressure)
        {
            SimulatedInput.SetControl(Right + "isTracked", 1f);
            SimulatedInput.SetControl(Right + "tipPose/position", deskPosition + deskRotation * onDesk);
            SimulatedInput.SetControl(Right + "tipPose/rotation", Quaternion.identity);
            SimulatedInput.SetControl(Right + "tip", pressure);
        }

        private static void Press(string control)
        {
            SimulatedInput.SetControl(control, 1f);
            World.Frames(2);
            SimulatedInput.SetControl(control, 0f);
            World.Frames(2);
        }

        private static AlignmentStep Step() => UnityEngine.Object
            .FindObjectsByType<AlignmentStep>(FindObjectsInactive.Include, FindObjectsSortMode.None).Single();

        private static HapticStylus Pen() => UnityEngine.Object
            .FindObjectsByType<HapticStylus>(FindObjectsInactive.Exclude, FindObjectsSortMode.None)
            .Single(pen => pen.Force != null);

        private static GameObject[] Marks() => Enumerable.Range(0, Step().transform.childCount)
            .Select(index => Step().transform.GetChild(index).gameObject)
            .Where(child => child.name.StartsWith("Mark", StringComparison.Ordinal)).ToArray();
    }
}
