using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;
using HaptoFlow.SampleScenes;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    public sealed class StylusTracingTests : SampleTest
    {
        private Camera camera = null!;
        private TracingScene scene = null!;

        [SetUp]
        public void BuildScene()
        {
            FinishLoading();
            camera = CameraOf(new SceneFile("StylusTracing"));
            scene = Wake<TracingScene>(bootstrap => bootstrap.View = camera);
        }

        [Test]
        public void TheSceneHasEightObjectsWithEightLabelsOfTheModel()
        {
            List<string> labels = Surfaces().Select(surface => surface.Material.Label).ToList();
            Assert.That(labels, Has.Count.EqualTo(8));
            Assert.That(labels, Is.Unique);
            Assert.That(labels, Is.SubsetOf(HaptoFlowSettings.Active.Model!.Header.Labels.Select(label => label.Name)));
            Assert.That(Surfaces().Select(surface => surface.Colliders.Count), Has.All.EqualTo(1));
        }

        [Test]
        public void TheScenesCameraSeesEveryObject()
        {
            foreach (Exhibit exhibit in Exhibits.All.Skip(1))
            {
                Vector3 pixels = camera.WorldToScreenPoint(exhibit.Position);
                Assert.That(pixels.z, Is.GreaterThan(0f), exhibit.Name);
                Assert.That(pixels.x, Is.InRange(0f, camera.pixelWidth), exhibit.Name);
                Assert.That(pixels.y, Is.InRange(0f, camera.pixelHeight), exhibit.Name);
            }
        }

        [Test]
        public void ThePenTouchesTheObjectUnderTheMouse()
        {
            foreach (Exhibit exhibit in Exhibits.All)
            {
                // There is no object on the front of the table.
                Vector3 place = exhibit.Name == "Table" ? new Vector3(0f, 0f, 0f) : exhibit.Position;
                string touched = Stroke(place);
                Assert.That(touched, Is.EqualTo(exhibit.Label));
            }
        }

        [Test]
        public void WithoutTheButtonThePenHoversAndRunsNoInference()
        {
            PointAt(camera, new Vector3(0.115f, 0.006f, -0.12f));
            PlayFor(0.5);
            Assert.That(scene.Pen.Stylus.IsTouching, Is.False);
            Assert.That(scene.Pen.transform.position.y, Is.EqualTo(0.036f).Within(1e-3f));
            Assert.That(InferencesOf(scene.Pen.Stylus), Is.Zero);
        }

        [Test]
        public void ThePressureOfAGraphicsPenSetsTheForce()
        {
            PointAt(camera, new Vector3(0.115f, 0.006f, -0.12f));
            SimulatedInput.PenPressure = 0.25f;
            PlayFor(0.5);
            float light = scene.Pen.Stylus.Contact.ForceNewtons;
            SimulatedInput.PenPressure = 1f;
            PlayFor(0.5);
            Assert.That(light, Is.GreaterThan(0f));
            Assert.That(scene.Pen.Stylus.Contact.ForceNewtons, Is.EqualTo(4f * light).Within(0.05f * light));
        }

        [Test]
        public void AStillPenFeelsTheMovingGrille()
        {
            PointAt(camera, new Vector3(0.3f, 0.022f, 0.12f));
            SimulatedInput.MouseButton = true;
            PlayFor(0.5);
            AudioDevice.Forget();
            float fastest = 0f;
            for (int frame = 0; frame < 2.0 * World.FrameRateHz; ++frame)
            {
                World.Frame();
                fastest = Mathf.Max(fastest, scene.Pen.Stylus.Contact.TangentialVelocity.magnitude);
            }
            Assert.That(scene.Pen.Stylus.Contact.Material!.Label, Is.EqualTo("metal mesh"));
            Assert.That(fastest, Is.EqualTo(0.04f * Mathf.PI).Within(0.05f * 0.04f * Mathf.PI));
            Assert.That(Loudest(), Is.GreaterThan(Audible));
        }

        [Test]
        public void TheBoardShowsTheTouchedLabel()
        {
            var board = FindAll<StatusBoard>().Single();
            PlayFor(0.5);
            Assert.That(board.Text, Does.Contain("left mouse button"));
            Stroke(new Vector3(0.115f, 0.006f, -0.12f));
            Assert.That(board.Text, Does.StartWith("rubber: 0."));
        }

        [Test]
        public void TheSamplesModelIsUsedOnlyWhenTheProjectHasNone()
        {
            HapticModelAsset projects = HaptoFlowSettings.Active.Model!;
            HapticModelAsset samples = DefaultModel.Asset();
            Wake<TracingScene>(bootstrap => (bootstrap.View, bootstrap.Model) = (camera, samples));
            Assert.That(HaptoFlowSettings.Active.Model, Is.SameAs(projects));
            HaptoFlowSettings.Active.Model = null;
            Wake<TracingScene>(bootstrap => (bootstrap.View, bootstrap.Model) = (camera, samples));
            Assert.That(HaptoFlowSettings.Active.Model, Is.SameAs(samples));
        }

        /// <summary>Draws a small circle around a place, returns the touched label, and leaves the pen there.</summary>
        private string Stroke(Vector3 place)
        {
            SimulatedInput.MouseButton = false;
            PointAt(camera, place);
            PlayFor(0.3);
            AudioDevice.Forget();
            ulong before = InferencesOf(scene.Pen.Stylus);
            SimulatedInput.MouseButton = true;
            for (int frame = 0; frame < 0.6 * World.FrameRateHz; ++frame)
            {
                double angle = 2.0 * Math.PI * 2.0 * frame / World.FrameRateHz;
                var aside = new Vector3((float)Math.Cos(angle), 0f, (float)Math.Sin(angle));
                PointAt(camera, place + 0.015f * aside);
                World.Frame();
            }
            Assert.That(scene.Pen.Stylus.IsTouching, Is.True, place.ToString());
            Assert.That(Loudest(), Is.GreaterThan(Audible), scene.Pen.Stylus.Contact.Collider.name);
            Assert.That(InferencesOf(scene.Pen.Stylus), Is.GreaterThan(before));
            return scene.Pen.Stylus.Contact.Material!.Label;
        }

        private static IEnumerable<HapticSurface> Surfaces() => FindAll<HapticSurface>();

        private static T[] FindAll<T>()
            where T : UnityEngine.Object =>
            UnityEngine.Object.FindObjectsByType<T>(FindObjectsInactive.Exclude, FindObjectsSortMode.None);
    }
}
