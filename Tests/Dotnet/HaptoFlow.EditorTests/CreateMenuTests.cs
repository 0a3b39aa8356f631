using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityEngine.Rendering;
using UnityShim;

namespace HaptoFlow.EditorTests
{
    /// <summary>The menu GameObject > HaptoFlow: what it creates, and that one undo removes it.</summary>
    public sealed class CreateMenuTests : EditorTest
    {
        private Camera camera = null!;

        [SetUp]
        public void OpenANewScene()
        {
            GameObject owner = Make("Main Camera");
            owner.tag = "MainCamera";
            owner.transform.position = new Vector3(0f, 1f, -10f);
            camera = owner.AddComponent<Camera>();
            Undo.IncrementCurrentGroup();
        }

        [Test]
        public void OneCommandCreatesAFirstSceneAndOneUndoRemovesIt()
        {
            CreateMenu.CreateFirstScene(new MenuCommand(null));
            Assert.That(All<HapticSurface>().Single().Material.Label, Is.EqualTo("wood"));
            Assert.That(All<MousePen>().Single().Stylus, Is.SameAs(All<HapticStylus>().Single()));
            Assert.That(All<HapticOutput>().Single().Processing.Listen, Is.True, "wood is heard on loudspeakers");
            Assert.That(camera.transform.position.magnitude, Is.LessThan(1f), "the camera is near enough to see 30 cm");
            Undo.PerformUndo();
            Assert.That(All<HapticSurface>(), Is.Empty);
            Assert.That(All<HapticStylus>(), Is.Empty);
            Assert.That(All<HapticOutput>(), Is.Empty);
            Assert.That(camera.transform.position, Is.EqualTo(new Vector3(0f, 1f, -10f)));
        }

        [Test]
        public void AFirstSceneTwiceAddsNothing()
        {
            CreateMenu.CreateFirstScene(new MenuCommand(null));
            int before = Count();
            Undo.IncrementCurrentGroup();
            CreateMenu.CreateFirstScene(new MenuCommand(null));
            Assert.That(Count(), Is.EqualTo(before));
            Assert.That(Selection.activeObject, Is.SameAs(All<HapticSurface>().Single().gameObject));
        }

        [Test]
        public void AFirstSceneUsesTheOutputThatTheSceneHas()
        {
            HapticOutput output = Output();
            CreateMenu.CreateFirstScene(new MenuCommand(null));
            Assert.That(All<HapticOutput>(), Is.EqualTo(new[] { output }));
        }

        [Test]
        public void AFirstSceneInARigHasAPenInEachHandAndAPlateInReachAndOneUndoRemovesThem()
        {
            GameObject rig = Make("XR Origin");
            rig.AddComponent<XROrigin>();
            rig.transform.SetPositionAndRotation(new Vector3(3f, 0f, 2f), Quaternion.AngleAxis(90f, Vector3.up));
            GameObject space = Make("Camera Offset", rig);
            camera.transform.SetParent(space.transform, false);
            int before = Count();
            CreateMenu.CreateFirstScene(new MenuCommand(null));
            Assert.That(All<XrPen>().Select(pen => pen.Hand), Is.EquivalentTo(new[] { PenHand.Right, PenHand.Left }));
            Assert.That(All<XrPen>().Select(pen => pen.transform.parent), Is.All.SameAs(space.transform));
            Assert.That(All<MousePen>(), Is.Empty);
            Vector3 plate = All<HapticSurface>().Single().transform.position;
            Assert.That(Vector3.Distance(plate, new Vector3(3.4f, 0.74f, 2f)), Is.LessThan(1e-3f), "in front of the rig");
            int all = Count();
            CreateMenu.CreateFirstScene(new MenuCommand(null));
            Assert.That(Count(), Is.EqualTo(all), "a second time adds nothing");
            Undo.PerformUndo();
            Undo.PerformUndo();
            Assert.That(Count(), Is.EqualTo(before));
        }

        [Test]
        public void ASecondPenForTheSameHandIsTheFirstOne()
        {
            CreateMenu.CreateRightPen(new MenuCommand(null));
            Selection.activeObject = null;
            CreateMenu.CreateRightPen(new MenuCommand(null));
            Assert.That(Selection.activeObject, Is.SameAs(All<XrPen>().Single().gameObject));
        }

        [Test]
        public void TheCameraOfAFirstSceneSeesThePlate()
        {
            CreateMenu.CreateFirstScene(new MenuCommand(null));
            foreach (float side in new[] { -0.15f, 0.15f })
            {
                Vector3 pixels = camera.WorldToScreenPoint(new Vector3(side, 0f, side));
                Assert.That(pixels.x, Is.InRange(0f, camera.pixelWidth));
                Assert.That(pixels.y, Is.InRange(0f, camera.pixelHeight));
            }
        }

        [Test]
        public void ATaggedCubeHasThePipelinesMaterialUntilTheUserChoosesAnother()
        {
            var pipeline = ScriptableObject.CreateInstance<SimulatedPipeline>();
            pipeline.Material = new Material(SimulatedPipeline.ShaderNamed("Lit"));
            GraphicsSettings.defaultRenderPipeline = pipeline;
            CreateMenu.CreateTaggedCube(new MenuCommand(null));
            var renderer = All<HapticSurface>().Single().GetComponent<MeshRenderer>();
            Assert.That(renderer.sharedMaterial, Is.SameAs(pipeline.Material));
            var chosen = new Material(SimulatedPipeline.ShaderNamed("Chosen"));
            renderer.sharedMaterial = chosen;
            BuildHost.ProcessScene(null);
            EditorSession.Play();
            World.Frames(2);
            Assert.That(renderer.sharedMaterial, Is.SameAs(chosen));
            EditorSession.Stop();
            GraphicsSettings.defaultRenderPipeline = null;
        }

        [Test]
        public void TheSelectedObjectBecomesTheParentOfANewObject()
        {
            GameObject hand = Make("Hand");
            CreateMenu.CreateRightPen(new MenuCommand(hand));
            CreateMenu.CreateMousePen(new MenuCommand(hand));
            CreateMenu.CreateOutput(new MenuCommand(hand));
            CreateMenu.CreateTaggedCube(new MenuCommand(hand));
            Assert.That(hand.transform.childCount, Is.EqualTo(4));
            Assert.That(Selection.activeObject, Is.SameAs(All<HapticSurface>().Single().gameObject));
        }

        [Test]
        public void EveryCreatedObjectIsRemovedByItsOwnUndo()
        {
            System.Action<MenuCommand>[] commands =
            {
                CreateMenu.CreateRightPen, CreateMenu.CreateLeftPen, CreateMenu.CreateMousePen, CreateMenu.CreateOutput,
                CreateMenu.CreateTaggedCube, CreateMenu.CreateStylus,
            };
            int before = Count();
            foreach (System.Action<MenuCommand> command in commands)
            {
                Undo.IncrementCurrentGroup();
                command(new MenuCommand(null));
                Assert.That(Count(), Is.GreaterThan(before), command.Method.Name);
                Undo.PerformUndo();
                Assert.That(Count(), Is.EqualTo(before), command.Method.Name);
            }
        }

        /// <summary>Stands for the component of that name in Unity's XR Core Utilities.</summary>
        private sealed class XROrigin : MonoBehaviour
        {
        }

        private static int Count() => All<Transform>().Length;

        private static T[] All<T>()
            where T : Object => Object.FindObjectsByType<T>(FindObjectsInactive.Include, FindObjectsSortMode.None);
    }
}
