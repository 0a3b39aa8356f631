using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using HaptoFlow.Editor;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.EditorTests
{
    /// <summary>The package's hand-written prefabs equal the objects that the menu creates.</summary>
    public sealed class PrefabTests : EditorTest
    {
        private const float Same = 1e-6f;
        private const string Package = "Packages/com.haptoflow.runtime/Runtime/";
        private readonly Dictionary<string, Object> made = new Dictionary<string, Object>();

        [TestCase("Mouse Pen")]
        [TestCase("XR Pen Right")]
        [TestCase("XR Pen Left")]
        public void ThePrefabEqualsTheObjectThatTheMenuCreates(string name)
        {
            GameObject owner = name switch
            {
                "Mouse Pen" => MousePen.Create(null).gameObject,
                "XR Pen Right" => XrPen.Create(null, PenHand.Right).gameObject,
                _ => XrPen.Create(null, PenHand.Left).gameObject,
            };
            var file = new PrefabFile(RepositoryFiles.In(
                Package.Split('/', StringSplitOptions.RemoveEmptyEntries).Append("Prefabs").Append(name + ".prefab")
                    .ToArray()));
            Assert.That(owner.name, Is.EqualTo(name));
            Match(file, file.Root, owner.transform);
            Compare(file, file.Root, owner.transform);
            Object.DestroyImmediate(owner);
        }

        /// <summary>Maps the anchors of the prefab to objects.</summary>
        private void Match(PrefabFile file, PrefabObject written, Transform place)
        {
            IReadOnlyList<PrefabObject> components = file.ComponentsOf(written);
            var present = new List<Component>();
            place.GetComponents(present);
            Assert.That(components.Select(TypeOf), Is.EqualTo(present.Select(each => each.GetType().Name)),
                file.PathOf(written));
            for (int index = 0; index < components.Count; ++index)
            {
                made[components[index].Anchor] = present[index];
            }
            IReadOnlyList<string> children = written.List("m_Children");
            Assert.That(children.Count, Is.EqualTo(place.childCount), file.PathOf(written));
            for (int index = 0; index < children.Count; ++index)
            {
                Match(file, file[children[index]], place.GetChild(index));
            }
        }

        private void Compare(PrefabFile file, PrefabObject written, Transform place)
        {
            string path = file.PathOf(written);
            PrefabObject owner = file[PrefabObject.Reference(written["m_GameObject"])];
            Assert.That(owner["m_Name"], Is.EqualTo(place.name));
            Assert.That(owner["m_IsActive"] == "1", Is.EqualTo(place.gameObject.activeSelf), path);
            Assert.That(Vector(written["m_LocalPosition"]), Is.EqualTo(place.localPosition), path);
            Assert.That(Vector(written["m_LocalScale"]), Is.EqualTo(place.localScale), path);
            float[] turn = PrefabObject.Numbers(written["m_LocalRotation"]);
            var rotation = new Quaternion(turn[0], turn[1], turn[2], turn[3]);
            Assert.That(Quaternion.Dot(rotation, place.localRotation), Is.EqualTo(1f).Within(Same), path);
            foreach (PrefabObject component in file.ComponentsOf(written))
            {
                Compare(component, path + ": " + TypeOf(component));
            }
            foreach (string child in written.List("m_Children"))
            {
                Compare(file, file[child], ((Transform)made[child]));
            }
        }

        private void Compare(PrefabObject component, string where)
        {
            Object present = made[component.Anchor];
            switch (present)
            {
                case CapsuleCollider capsule:
                    Assert.That(component["m_Enabled"] == "1", Is.EqualTo(capsule.enabled), where);
                    Assert.That(Number(component["m_Radius"]), Is.EqualTo(capsule.radius), where);
                    Assert.That(Number(component["m_Height"]), Is.EqualTo(capsule.height), where);
                    Assert.That(component["m_Direction"], Is.EqualTo(capsule.direction.ToString()), where);
                    break;
                case MeshFilter _:
                    // Unity's capsule mesh, one of its default resources.
                    Assert.That(component["m_Mesh"], Does.StartWith("{fileID: 10208, guid: 0000000000000000e0"), where);
                    break;
                case MonoBehaviour script:
                    foreach (string field in component.ScriptFields)
                    {
                        Compare(component, field, script, where + "." + field);
                    }
                    break;
            }
        }

        private void Compare(PrefabObject component, string field, MonoBehaviour script, string where)
        {
            FieldInfo? declared = null;
            for (Type? type = script.GetType(); type != null && declared == null; type = type.BaseType)
            {
                declared = type.GetField(field, BindingFlags.Instance | BindingFlags.NonPublic);
            }
            Assert.That(declared, Is.Not.Null, where);
            object? value = declared!.GetValue(script);
            string written = component[field];
            switch (value)
            {
                case float number:
                    Assert.That(Number(written), Is.EqualTo(number), where);
                    break;
                case Enum choice:
                    Assert.That(written, Is.EqualTo(Convert.ToInt32(choice).ToString()), where);
                    break;
                case LayerMask layers:
                    Assert.That(component[field + ".m_Bits"], Is.EqualTo(((uint)layers.value).ToString()), where);
                    break;
                case Color colour:
                    Assert.That(PrefabObject.Numbers(written),
                        Is.EqualTo(new[] { colour.r, colour.g, colour.b, colour.a }), where);
                    break;
                case Object referred when referred != null:
                    Assert.That(made[PrefabObject.Reference(written)], Is.SameAs(referred), where);
                    break;
                case null:
                    Assert.That(PrefabObject.Reference(written), Is.EqualTo("0"), where);
                    break;
                default:
                    Assert.Fail($"{where}: the test knows no {value.GetType().Name}");
                    break;
            }
        }

        private static string TypeOf(PrefabObject component)
        {
            if (component.Type != "MonoBehaviour")
            {
                return component.Type;
            }
            string guid = component["m_Script"].Split("guid: ")[1].Split(',')[0];
            string folder = RepositoryFiles.In(Package.Split('/', StringSplitOptions.RemoveEmptyEntries));
            string meta = Directory.EnumerateFiles(folder, "*.cs.meta", SearchOption.AllDirectories)
                .Single(candidate => File.ReadAllText(candidate).Contains("guid: " + guid));
            return Path.GetFileName(meta).Replace(".cs.meta", "");
        }

        private static float Number(string text) => float.Parse(text, CultureInfo.InvariantCulture);

        private static Vector3 Vector(string text)
        {
            float[] numbers = PrefabObject.Numbers(text);
            return new Vector3(numbers[0], numbers[1], numbers[2]);
        }
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
