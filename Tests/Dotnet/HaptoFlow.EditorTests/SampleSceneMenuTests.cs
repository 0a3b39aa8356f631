using System;
using System.Collections.Generic;
using System.Globalization;
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
            var file = new PrefabFile(SampleFiles.Scene(sample));
            IEnumerable<string> written = file.Objects.Where(each => each.Type == "Transform")
                .Select(place => Describe(file, place));
            IEnumerable<string> made = default(UnityEngine.SceneManagement.Scene).GetRootGameObjects().Select(Describe);
            Assert.That(made, Is.EqualTo(written));
        }

        [TestCaseSource(nameof(Samples))]
        public void TheMenuSetsTheAmbientLightOfTheSamplesSceneFile(string sample)
        {
            Menus[sample]();
            PrefabObject written = new PrefabFile(SampleFiles.Scene(sample)).Objects
                .Single(each => each.Type == "RenderSettings");
            Assert.That(((int)RenderSettings.ambientMode).ToString(), Is.EqualTo(written["m_AmbientMode"]));
            Assert.That(Numbers(RenderSettings.ambientLight), Is.EqualTo(Numbers(written["m_AmbientSkyColor"])));
        }

        [Test]
        public void ThePanelOfTheWorkshopHasTheRecordingsOfTheSceneFile()
        {
            SampleSceneMenu.MakeWorkshop();
            IEnumerable<string> guids = Regex.Matches(
                File.ReadAllText(SampleFiles.Scene("Workshop")), @"fileID: 4900000, guid: (\w+)")
                .Select(match => match.Groups[1].Value);
            var panel = Object.FindObjectsByType<AddMaterialPanel>(
                FindObjectsInactive.Include, FindObjectsSortMode.None).Single();
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
            Assert.That(Selection.activeGameObject, Is.SameAs(Object.FindObjectsByType<GalleryScene>(
                FindObjectsInactive.Include, FindObjectsSortMode.None).Single().gameObject));
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

        private static string Describe(PrefabFile file, PrefabObject place)
        {
            PrefabObject owner = file[PrefabObject.Reference(place["m_GameObject"])];
            IEnumerable<string> components = file.ComponentsOf(place).Select(each => Describe(file, each, each.Type));
            return Lines(owner["m_Name"], owner["m_TagString"], components);
        }

        private static string Describe(PrefabFile file, PrefabObject written, string type) => type switch
        {
            "Transform" => Line(type, Numbers(written["m_LocalPosition"]), Numbers(written["m_LocalRotation"]),
                Numbers(written["m_LocalScale"])),
            "Camera" => Line(type, Number(written["m_ClearFlags"]), Numbers(written["m_BackGroundColor"]),
                Number(written["near clip plane"]), Number(written["far clip plane"]), Number(written["field of view"]),
                Number(written["m_Depth"])),
            "Light" => Line(type, Number(written["m_Type"]), Numbers(written["m_Color"]),
                Number(written["m_Intensity"]), Number(written["m_Shadows.m_Type"])),
            "MonoBehaviour" => Script(file, written),
            _ => type,
        };

        private static string Script(PrefabFile file, PrefabObject written)
        {
            string name = Path.GetFileNameWithoutExtension(FileOf(GuidIn(written["m_Script"])));
            return written.ScriptFields.Contains("view")
                ? $"{name} {Path.GetFileName(FileOf(GuidIn(written["model"])))} " +
                    file[PrefabObject.Reference(written["view"])].Type
                : name;
        }

        private static string Describe(GameObject owner)
        {
            var components = new List<Component>();
            owner.transform.GetComponents(components);
            return Lines(owner.name, owner.tag, components.Select(Describe));
        }

        private static string Describe(Component made)
        {
            string type = made.GetType().Name;
            switch (made)
            {
                case Transform place:
                    Quaternion turn = place.localRotation;
                    return Line(type, Numbers(place.localPosition), new[] { turn.x, turn.y, turn.z, turn.w },
                        Numbers(place.localScale));
                case Camera camera:
                    return Line(type, new[] { (float)camera.clearFlags }, Numbers(camera.backgroundColor),
                        new[] { camera.nearClipPlane }, new[] { camera.farClipPlane }, new[] { camera.fieldOfView },
                        new[] { camera.depth });
                case Light light:
                    return Line(type, new[] { (float)light.type }, Numbers(light.color), new[] { light.intensity },
                        new[] { (float)light.shadows });
                case BuiltScene scene:
                    return $"{type} {Path.GetFileName(AssetDatabase.GetAssetPath(scene.Model!))} " +
                        scene.View!.GetType().Name;
                default:
                    return type;
            }
        }

        // Unity adds a component that another one requires before that one; a scene file may have any order.
        private static string Lines(string name, string tag, IEnumerable<string> components) =>
            $"{name} [{tag}]\n{string.Join("\n", components.OrderBy(each => each, StringComparer.Ordinal))}";

        private static string Line(string type, params float[][] values) => type + " " + string.Join(" ",
            values.Select(each => string.Join(",", each.Select(
                value => (Math.Round(value, 4) + 0.0).ToString(CultureInfo.InvariantCulture)))));

        private static float[] Number(string text) => new[] { float.Parse(text, CultureInfo.InvariantCulture) };

        private static float[] Numbers(string text) => PrefabObject.Numbers(text);

        private static float[] Numbers(Vector3 vector) => new[] { vector.x, vector.y, vector.z };

        private static float[] Numbers(Color colour) => new[] { colour.r, colour.g, colour.b, colour.a };

        private static string GuidIn(string text) => Regex.Match(text, "guid: (\\w+)").Groups[1].Value;

        private static string GuidOf(Object asset) => GuidIn(File.ReadAllText(
            RepositoryFiles.In(AssetDatabase.GetAssetPath(asset).Split('/')) + ".meta"));

        private static string FileOf(string guid) => Directory
            .EnumerateFiles(RepositoryFiles.In("Packages", "com.haptoflow.runtime"), "*.meta", SearchOption.AllDirectories)
            .Single(meta => File.ReadAllText(meta).Contains("guid: " + guid)).Replace(".meta", "");

        private static object? PrivateField(object owner, string name) => owner.GetType().GetField(
            name, System.Reflection.BindingFlags.Instance | System.Reflection.BindingFlags.NonPublic)!.GetValue(owner);
    }
}
