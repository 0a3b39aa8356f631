using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.SampleScenes;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    public sealed class TextureGalleryTests : SampleTest
    {
        private Camera camera = null!;

        [SetUp]
        public void MakeCamera() =>
            camera = CameraOf(new SceneFile("TextureGallery"));

        [Test]
        public void EveryLabelOfTheModelHasATileInTheModelsOrder()
        {
            GalleryScene gallery = Open();
            IEnumerable<string> labels = HaptoFlowSettings.Active.Model!.Header.Labels.Select(label => label.Name);
            Assert.That(gallery.Tiles.Select(tile => tile.Material.Label), Is.EqualTo(labels));
            Assert.That(gallery.Tiles.Count, Is.GreaterThanOrEqualTo(8));
        }

        [Test]
        public void TilesAndBoardAreInTheCamerasViewAndDoNotOverlap()
        {
            GalleryScene gallery = Open();
            List<Transform> places = gallery.Tiles.Append(gallery.Board).Select(surface => surface.transform).ToList();
            foreach (Transform place in places)
            {
                foreach (float side in new[] { -0.5f, 0.5f })
                {
                    Vector3 pixels = camera.WorldToScreenPoint(place.position + side * place.localScale);
                    Assert.That(pixels.x, Is.InRange(0f, camera.pixelWidth), place.name);
                    Assert.That(pixels.y, Is.InRange(0f, camera.pixelHeight), place.name);
                }
                foreach (Transform other in places.Where(other => other != place))
                {
                    Vector3 apart = other.position - place.position;
                    Vector3 reach = 0.5f * (other.localScale + place.localScale);
                    bool touching = Math.Abs(apart.x) < reach.x && Math.Abs(apart.y) < reach.y;
                    Assert.That(touching, Is.False, $"{place.name} and {other.name}");
                }
            }
        }

        [Test]
        public void PressingATilePicksItsLabelForTheBoard()
        {
            FinishLoading();
            GalleryScene gallery = Open();
            HapticSurface fur = gallery.Tiles.Single(tile => tile.Material.Label == "fur");
            Assert.That(gallery.Board.Material.Label, Is.Not.EqualTo("fur"));
            PointAt(camera, fur.transform.position);
            SimulatedInput.MouseButton = true;
            PlayFor(0.3);
            Assert.That(gallery.Pen.Stylus.Contact.Surface, Is.SameAs(fur));
            Assert.That(gallery.Board.Material.Label, Is.EqualTo("fur"));

            SimulatedInput.MouseButton = false;
            PlayFor(0.2);
            AudioDevice.Forget();
            SimulatedInput.MouseButton = true;
            for (int frame = 0; frame < 0.8 * World.FrameRateHz; ++frame)
            {
                float x = 0.1f * (float)Math.Sin(2.0 * Math.PI * frame / World.FrameRateHz);
                PointAt(camera, gallery.Board.transform.position + new Vector3(x, 0f, 0f));
                World.Frame();
            }
            Assert.That(gallery.Pen.Stylus.Contact.Surface, Is.SameAs(gallery.Board));
            Assert.That(gallery.Board.Material.Label, Is.EqualTo("fur"));
            Assert.That(InferencesOf(gallery.Pen.Stylus), Is.GreaterThan(0UL));
            Assert.That(Loudest(), Is.GreaterThan(Audible));
        }

        [Test]
        public void WithoutAModelTheWallIsEmptyAndTheBoardShowsTheReason()
        {
            HapticSession.ShutDown();
            HaptoFlowSettings.Active.Model = null;
            GalleryScene gallery = Open();
            PlayFor(0.5);
            Assert.That(gallery.Tiles, Is.Empty);
            StatusBoard[] boards = UnityEngine.Object.FindObjectsByType<StatusBoard>(
                FindObjectsInactive.Exclude, FindObjectsSortMode.None);
            Assert.That(boards.Single().Text, Does.Contain("no model is chosen"));
        }

        private GalleryScene Open() => Wake<GalleryScene>(bootstrap => bootstrap.View = camera);
    }
}
