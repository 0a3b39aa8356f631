#nullable enable
using System.Collections;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    public sealed class SurfaceSeedTests : SceneTest
    {
        [Test]
        public void TwoObjectsOfOneLabelDiffer() => Assert.That(Of(Board()), Is.Not.EqualTo(Of(Board())));

        [Test]
        public void AnObjectWithASeedKeepsItWhereverItIs()
        {
            HapticSurface board = Board();
            board.Seed = 7;
            board.transform.SetParent(Make("room").transform, false);
            Assert.That(Of(board), Is.EqualTo(7u));
        }

        [Test]
        public void CollidersOfOneSurfaceDifferUnlessTheyShareAnObject([Values(0u, 7u)] uint seed)
        {
            HapticSurface board = Board();
            board.Seed = seed;
            Collider own = board.GetComponent<BoxCollider>();
            Collider beside = board.gameObject.AddComponent<SphereCollider>();
            Collider first = Part(board.gameObject);
            Collider second = Part(board.gameObject);
            Collider below = Part(first.gameObject);
            Assert.That(SurfaceSeeds.Of(beside, board), Is.EqualTo(SurfaceSeeds.Of(own, board)));
            Assert.That(new[] { own, first, second, below }, Is.Unique.Using<Collider>((left, right) =>
                SurfaceSeeds.Of(left, board) == SurfaceSeeds.Of(right, board)));
        }

        [Test]
        public void ThePlaceInTheHierarchyGivesTheSameNumberAfterAReload()
        {
            uint[] Load()
            {
                GameObject room = Make("room");
                uint[] numbers = { SurfaceSeeds.Of(Part(room), null), SurfaceSeeds.Of(Part(room), null) };
                Object.DestroyImmediate(room);
                return numbers;
            }
            uint[] before = Load();
            Assert.That(Load(), Is.EqualTo(before));
            Assert.That(before[0], Is.Not.EqualTo(before[1]));
        }

        [UnityTest]
        public IEnumerator AContactNamesItsSurfaceAndThePlaceOnItWhereverTheObjectIs()
        {
            HapticSurface board = Board();
            board.Seed = 7;
            var contacts = new TipContacts(new ContactSettings(), 0.002, Make("Stylus").transform);
            yield return null;
            ContactReading before = Touch(contacts, board, 1.0);
            board.transform.position = new Vector3(0.4f, 0.2f, -0.1f);
            board.transform.rotation = Quaternion.AngleAxis(50f, new Vector3(0.6f, 0f, 0.8f));
            yield return null;
            ContactReading after = Touch(contacts, board, 2.0);
            foreach (ContactReading reading in new[] { before, after })
            {
                Assert.That(reading.State.HasPlace, Is.True);
                Assert.That(reading.State.SurfaceSeed, Is.EqualTo(7u));
                Assert.That(reading.State.PlaceMetres.X, Is.EqualTo(0.03f).Within(1e-5f));
                Assert.That(reading.State.PlaceMetres.Y, Is.EqualTo(0f).Within(1e-5f));
                Assert.That(reading.State.PlaceMetres.Z, Is.EqualTo(0.04f).Within(1e-5f));
                Assert.That(reading.State.FirstAxis.X, Is.EqualTo(1f).Within(1e-5f));
                Assert.That(reading.State.SecondAxis.Z, Is.EqualTo(-1f).Within(1e-5f));
            }
            var lost = new TipSample(3.0, new Double3(double.NaN, 0.0, 0.0), null);
            ContactReading none = contacts.Update(lost, 3.0, -1, HapticSession.Current, board);
            Assert.That(none.State.HasPlace, Is.False);
        }

        private static ContactReading Touch(TipContacts contacts, HapticSurface board, double seconds)
        {
            Vector3 tip = board.transform.TransformPoint(new Vector3(0.03f, 0.001f, 0.04f));
            return contacts.Update(new TipSample(seconds, tip.ToDouble(), null), seconds, -1, HapticSession.Current, board);
        }

        private static uint Of(HapticSurface surface) => SurfaceSeeds.Of(surface.GetComponent<BoxCollider>(), surface);

        private Collider Part(GameObject parent)
        {
            GameObject part = Make("part");
            part.transform.SetParent(parent.transform, false);
            return part.AddComponent<BoxCollider>();
        }
    }
}
