using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.Editor;
using HaptoFlow.SampleScenes;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityEngine.Rendering;
using UnityShim;
using Object = UnityEngine.Object;

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
        public void AFirstSceneUsesTheOutputAndTheCameraThatTheSceneHas()
        {
            HapticOutput output = Output();
            camera.transform.position = new Vector3(1f, 1f, 1f);
            CreateMenu.CreateFirstScene(new MenuCommand(null));
            Assert.That(All<HapticOutput>(), Is.EqualTo(new[] { output }));
            Assert.That(camera.transform.position, Is.EqualTo(new Vector3(1f, 1f, 1f)), "the user has moved it");
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
    }

    public sealed class DeviceCheckMenuTests : EditorTest
    {
        [Test]
        public void TheMenuAddsOneCheckSelectsItAndUndoRemovesIt()
        {
            Undo.IncrementCurrentGroup();
            DeviceCheckMenu.Add();
            DeviceCheckMenu.Add();
            Assert.That(All<DeviceCheckRun>(), Has.Length.EqualTo(1));
            Assert.That(Selection.activeGameObject, Is.SameAs(All<DeviceCheckRun>().Single().gameObject));
            Undo.PerformUndo();
            Assert.That(All<DeviceCheckRun>(), Is.Empty);
        }
    }

    /// <summary>The menu Window > HaptoFlow > Sample Scenes makes the scenes that the samples have as files.</summary>
    public sealed class SampleSceneMenuTests : EditorTest
    {
        private static readonly Dictionary<string, Action> Menus = new Dictionary<string, Action>
        {
            ["StylusTracing"] = SampleSceneMenu.MakeStylusTracing,
            ["TextureGallery"] = SampleSceneMenu.MakeTextureGallery,
            ["Workshop"] = SampleSceneMenu.MakeWorkshop,
            ["DeviceCheck"] = SampleSceneMenu.MakeDeviceCheck,
        };

        private static readonly string[] Samples = Menus.Keys.ToArray();

        [TestCaseSource(nameof(Samples))]
        public void TheMenuMakesTheObjectsOfTheSamplesSceneFile(string sample)
        {
            Menus[sample]();
            GameObject[] made = default(UnityEngine.SceneManagement.Scene).GetRootGameObjects();
            string path = SampleFiles.Scene(sample);
            IEnumerable<string> models = Regex.Matches(File.ReadAllText(path), @"  model: {fileID: \d+, guid: (\w+)")
                .Select(match => match.Groups[1].Value);
            Assert.That(All<BuiltScene>().Select(each => GuidOf(each.Model!)), Is.EqualTo(models));
            Assert.That(ProjectScene.Load(path).Roots.Select(SceneText.Of), Is.EqualTo(made.Select(SceneText.Of)));
            var file = new PrefabFile(path);
            PrefabObject render = file.Objects.Single(each => each.Type == "RenderSettings");
            Assert.That(((int)RenderSettings.ambientMode).ToString(), Is.EqualTo(render["m_AmbientMode"]));
            Assert.That(Numbers(RenderSettings.ambientLight), Is.EqualTo(Numbers(render["m_AmbientSkyColor"])));
        }

        [Test]
        public void ThePanelOfTheWorkshopHasTheRecordingsOfTheSceneFile()
        {
            SampleSceneMenu.MakeWorkshop();
            IEnumerable<string> guids = Regex.Matches(
                File.ReadAllText(SampleFiles.Scene("Workshop")), @"fileID: 4900000, guid: (\w+)")
                .Select(match => match.Groups[1].Value);
            var panel = All<AddMaterialPanel>().Single();
            var beside = (TextAsset[])PrivateField(panel, "beside")!;
            TextAsset[] recordings = beside.Prepend((TextAsset)PrivateField(panel, "recording")!).ToArray();
            Assert.That(recordings.Select(each => GuidOf(each)), Is.EqualTo(guids));
        }

        [Test]
        public void ModifiedScenesAreSavedFirstAndTheNewSceneIsModified()
        {
            GameObject before = Make("Mine");
            EditorSession.CancelsSaving = true;
            SampleSceneMenu.MakeTextureGallery();
            Assert.That(before != null, Is.True, "the user pressed Cancel");
            Assert.That(EditorSession.SceneIsDirty, Is.False);
            EditorSession.CancelsSaving = false;
            SampleSceneMenu.MakeTextureGallery();
            Assert.That(before == null, Is.True);
            Assert.That(EditorSession.SceneIsDirty, Is.True);
            Assert.That(Selection.activeGameObject, Is.SameAs(All<GalleryScene>().Single().gameObject));
        }

        [Test]
        public void TheMenuIsGreyInPlayMode()
        {
            Assert.That(SampleSceneMenu.CanMake(), Is.True);
            EditorSession.Play();
            Assert.That(SampleSceneMenu.CanMake(), Is.False);
        }

        [TestCaseSource(nameof(Samples))]
        public void ASceneOfTheMenuPlays(string sample)
        {
            Menus[sample]();
            GameObject[] made = default(UnityEngine.SceneManagement.Scene).GetRootGameObjects();
            EditorSession.Play();
            World.Frames(3);
            Assert.That(Object.FindObjectsByType<MousePen>(FindObjectsInactive.Exclude, FindObjectsSortMode.None),
                Has.Length.EqualTo(1));
            Assert.That(made, Has.Length.EqualTo(3));
        }

        private static float[] Numbers(string text) => PrefabObject.Numbers(text);

        private static float[] Numbers(Color colour) => new[] { colour.r, colour.g, colour.b, colour.a };

        private static string GuidIn(string text) => Regex.Match(text, "guid: (\\w+)").Groups[1].Value;

        private static string GuidOf(Object asset) => GuidIn(File.ReadAllText(
            RepositoryFiles.In(AssetDatabase.GetAssetPath(asset).Split('/')) + ".meta"));

        private static object? PrivateField(object owner, string name) => owner.GetType().GetField(
            name, System.Reflection.BindingFlags.Instance | System.Reflection.BindingFlags.NonPublic)!.GetValue(owner);
    }
}
