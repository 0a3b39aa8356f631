using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;
using SerializedFields = UnityShim.SerializedFields;

namespace HaptoFlow.EditorTests
{
    /// <summary>The package's hand-written prefabs equal the objects that the menu creates.</summary>
    public sealed class PrefabTests : EditorTest
    {
        [TestCase("Mouse Pen")]
        [TestCase("XR Pen Right")]
        [TestCase("XR Pen Left")]
        public void ThePrefabEqualsTheObjectThatTheMenuCreates(string name)
        {
            GameObject made = name switch
            {
                "Mouse Pen" => MousePen.Create(null).gameObject,
                "XR Pen Right" => XrPen.Create(null, PenHand.Right).gameObject,
                _ => XrPen.Create(null, PenHand.Left).gameObject,
            };
            string path = RepositoryFiles.In(
                "Packages", "com.haptoflow.runtime", "Runtime", "Prefabs", name + ".prefab");
            GameObject written = ProjectScene.Load(path).Roots.Single();
            Assert.That(SceneText.Of(written), Is.EqualTo(SceneText.Of(made)));
            // Unity's capsule mesh, one of its default resources.
            Assert.That(File.ReadAllText(path), Does.Contain("m_Mesh: {fileID: 10208, guid: 0000000000000000e0"));
            Object.DestroyImmediate(written);
            Object.DestroyImmediate(made);
        }
    }

    /// <summary>What a scene or a prefab stores of an object and of those below it, but for assets.</summary>
    internal static class SceneText
    {
        // Unity adds a component that another one requires before that one; a file may have any order.
        public static string Of(GameObject owner)
        {
            var components = new List<Component>();
            owner.transform.GetComponents(components);
            IEnumerable<string> children = Enumerable.Range(0, owner.transform.childCount)
                .Select(index => Of(owner.transform.GetChild(index).gameObject));
            return $"{owner.name} [{owner.tag}, {owner.activeSelf}]\n" + string.Join("\n",
                components.Select(Of).OrderBy(line => line, StringComparer.Ordinal).Concat(children));
        }

        private static string Of(Component component) => component switch
        {
            Transform place => Line(place, place.localPosition, place.localRotation, place.localScale),
            Camera camera => Line(camera, camera.clearFlags, camera.backgroundColor, camera.nearClipPlane,
                camera.farClipPlane, camera.fieldOfView, camera.depth),
            Light light => Line(light, light.type, light.color, light.intensity, light.shadows),
            CapsuleCollider capsule =>
                Line(capsule, capsule.enabled, capsule.radius, capsule.height, capsule.direction),
            MonoBehaviour script => Line(script, SerializedFields.Leaves(script)
                .Select(path => (object)(path + " " + Text(SerializedFields.Get(script, path)))).ToArray()),
            _ => component.GetType().Name,
        };

        private static string Line(Component component, params object[] values) =>
            component.GetType().Name + ": " + string.Join("; ", values.Select(Text));

        private static string Text(object? value) => value switch
        {
            float number => Text(number),
            Vector3 vector => Text(vector.x, vector.y, vector.z),
            Quaternion turn => Text(turn.x, turn.y, turn.z, turn.w),
            Color colour => Text(colour.r, colour.g, colour.b, colour.a),
            Component part => part.GetType().Name + " of " + part.name,
            Object _ => "",
            Array _ => "",
            LayerMask layers => layers.value.ToString(),
            _ => value?.ToString() ?? "",
        };

        private static string Text(params float[] numbers) => string.Join(" ",
            numbers.Select(number => (number + 0f).ToString("G5", CultureInfo.InvariantCulture)));
    }

    /// <summary>The scenes of the repository's Unity project in the editor.</summary>
    public sealed class ProjectScenesTests : EditorTest
    {
        [TestCase("Desk.unity")]
        [TestCase("Headset.unity")]
        public void CheckSceneFindsNothingToRepair(string name)
        {
            // As in the project's OpenXR settings, which the tests of the package read.
            MxInkSwitch.SwitchOn();
            ProjectScene scene = ProjectScene.Open(name);
            ProjectSettingsAsset.FindOrCreate();
            string[] findings = SceneCheck.Run().Select(finding => finding.Text).ToArray();
            foreach (GameObject each in scene.Owners.Where(each => each != null))
            {
                Object.DestroyImmediate(each);
            }
            Assert.That(findings, Is.Empty);
        }
    }
}
