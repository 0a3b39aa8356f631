#nullable enable
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEngine;

namespace HaptoFlow.EditorTests
{
    public sealed class SurfaceListTests : EditorTest
    {
        [Test]
        public void OnlyCollidersBelowTheSelectionAreListed()
        {
            Box("Elsewhere");
            GameObject room = Make("Room");
            Box("Lamp", room);
            SurfaceList list = SurfaceList.Of(new[] { room });
            Assert.That(list.OfSelection, Is.True);
            Assert.That(list.NotFelt.Select(line => line.Text), Is.EqualTo(new[] { "Lamp" }));
        }

        [Test]
        public void SelectingAnObjectWithoutCollidersListsTheScene()
        {
            Box("Lamp");
            Assert.That(SurfaceList.Of(new[] { Make("Camera") }).OfSelection, Is.False);
        }

        [Test]
        public void CollidersOfChildrenBelongToASurfaceThatIncludesThem()
        {
            HapticSurface table = Tagged("Table", "wood");
            Collider leg = Box("Leg", table.gameObject).GetComponent<BoxCollider>();
            Assert.That(SceneColliders.SurfaceOf(leg), Is.EqualTo(table));
            table.IncludeChildren = false;
            Assert.That(SceneColliders.SurfaceOf(leg), Is.Null);
        }

        [Test]
        public void AColliderBelongsToTheNearestSurfaceAbove()
        {
            HapticSurface table = Tagged("Table", "wood");
            GameObject plate = Box("Plate", table.gameObject);
            var glass = plate.AddComponent<HapticSurface>();
            glass.Material.Label = "glass";
            glass.Material.SecondLabel = "nothing known";
            Assert.That(SurfaceList.Of(new[] { plate }).Felt.Single().Text,
                Is.EqualTo("Plate: glass and nothing known (not in model)"));
        }

        [Test]
        public void TriggersAndDisabledCollidersAreNotListed()
        {
            Box("Zone").GetComponent<BoxCollider>().isTrigger = true;
            Box("Off").GetComponent<BoxCollider>().enabled = false;
            SurfaceList list = SurfaceList.Of(new GameObject[0]);
            Assert.That(list.NotFelt, Is.Empty);
            Assert.That(list.Felt, Is.Empty);
        }
    }
}
