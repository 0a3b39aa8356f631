#nullable enable
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.EditorTests
{
    public sealed class SurfaceCheckTests : SceneCheckTest
    {
        [Test]
        public void AnUnknownLabelIsFoundWithSimilarLabels()
        {
            HapticSurface shelf = Tagged("Shelf", "plywod");
            Finding finding = Only("has no label \"plywod\"");
            Assert.That(finding.Objects, Is.EqualTo(new Object[] { shelf }));
            Undo.IncrementCurrentGroup();
            Repair(finding, "Use \"plywood\"");
            Assert.That(shelf.Material.Label, Is.EqualTo("plywood"));
            Undo.PerformUndo();
            Assert.That(shelf.Material.Label, Is.EqualTo("plywod"));
        }

        [Test]
        public void AnUnknownSecondLabelIsFoundToo()
        {
            Tagged("Shelf", "wood").Material.SecondLabel = "asbestos";
            Assert.That(Only("has no label \"asbestos\"").Text, Does.Contain("its labels are: wood, plywood"));
        }

        [Test]
        public void ASharedMaterialIsOneFindingForAllItsSurfaces()
        {
            HapticMaterial shared = ScriptableObject.CreateInstance<HapticMaterial>();
            shared.name = "Bark";
            shared.Description.Label = "wod";
            foreach (string name in new[] { "Shelf", "Bench" })
            {
                Tagged(name, "wood").SharedMaterial = shared;
            }
            Finding finding = Only("Bark: the model has no label \"wod\"");
            Repair(finding, "Use \"wood\"");
            Assert.That(shared.Description.Label, Is.EqualTo("wood"));
        }

        [Test]
        public void ALearntMaterialOfAnotherModelIsFoundOnce()
        {
            string text = HaptoFlow.Model.MaterialText.OfLabel(Model().File, "glass");
            HapticMaterial known = HapticMaterial.Create(text, "wood");
            Tagged("Bottle", "wood").SharedMaterial = known;
            Assert.That(Texts(), Is.Empty);
            string space = Model().Header.Space;
            HapticMaterial foreign = HapticMaterial.Create(text.Replace(space, "0badcafe"), "wood");
            foreign.name = "Foreign";
            Tagged("Jar", "wood").SharedMaterial = foreign;
            Tagged("Cup", "wood").Material.Learnt = foreign;
            Finding finding = Only("Foreign is felt as its label \"wood\": it was learnt for another model");
            Assert.That(finding.Text, Does.Contain("Learn it again"));
            Assert.That(finding.Objects, Is.EqualTo(new Object[] { foreign }));
        }

        [Test]
        public void MoreLearntMaterialsThanAnEngineTakesAreFound()
        {
            string text = HaptoFlow.Model.MaterialText.OfLabel(Model().File, "glass");
            for (int number = 0; number < 65; ++number)
            {
                Tagged("Bottle", "wood").SharedMaterial = HapticMaterial.Create(text, "wood");
            }
            Only("use 65 learnt materials, but an engine takes at most 64");
        }

        [Test]
        public void ASurfaceWithoutALabelIsFound()
        {
            Tagged("Shelf", "");
            Only("Shelf has no label");
        }

        [Test]
        public void ASurfaceWithoutAColliderIsFound()
        {
            Make("Ghost").AddComponent<HapticSurface>();
            Only("Ghost is tagged, but has no collider");
        }

        [Test]
        public void AnUntaggedColliderIsTaggedByItsName()
        {
            GameObject door = Box("Steel Door");
            Repair(Only("Steel Door is not tagged; its name suggests metal"), "Tag as metal");
            Assert.That(door.GetComponent<HapticSurface>().Material.Label, Is.EqualTo("metal"));
        }

        [Test]
        public void UntaggedCollidersWithoutAProposalAreOneFinding()
        {
            for (int index = 0; index < 10; ++index)
            {
                Box("Thing " + index);
            }
            Finding finding = Only("no name suggests a label");
            Assert.That(finding.Objects, Has.Count.EqualTo(10));
            Assert.That(finding.Text, Does.EndWith("Thing 7 and 2 more."));
        }

        [Test]
        public void CollidersOnLayersThatNoStylusFeelsAreIgnored()
        {
            Box("Thing").layer = 4;
            ScenesStylus.Layers = ~(1 << 4);
            Assert.That(Texts(), Is.Empty);
        }

        [Test]
        public void AMeshThatIsNotConvexIsAFindingWithItsLimits()
        {
            MeshCollider mesh = MeshOn("Vase");
            mesh.sharedMesh = Tetrahedron();
            Finding finding = Only("are not convex");
            Assert.That(finding.Severity, Is.EqualTo(MessageType.Info));
            Assert.That(finding.Text, Does.Contain("20 mm").And.Contain("Vase"));
            mesh.convex = true;
            Assert.That(Texts(), Is.Empty);
        }

        [Test]
        public void AMeshColliderWithoutAMeshIsFound()
        {
            MeshOn("Vase");
            Only("have no mesh");
        }

        private MeshCollider MeshOn(string name)
        {
            GameObject owner = Make(name);
            owner.AddComponent<HapticSurface>();
            return owner.AddComponent<MeshCollider>();
        }

        private static Mesh Tetrahedron() => new Mesh
        {
            vertices = new[] { Vector3.zero, Vector3.right, Vector3.up, Vector3.forward },
            triangles = new[] { 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3 },
        };
    }
}
