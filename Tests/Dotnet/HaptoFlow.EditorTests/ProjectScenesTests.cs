using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.EditorTests
{
    /// <summary>The scenes of the repository's Unity project in the editor.</summary>
    public sealed class ProjectScenesTests : EditorTest
    {
        [Test]
        public void TheDeskIsTheFirstSceneOfTheMenu()
        {
            string[] desk = DescribeTheDesk();
            GameObject owner = Make("Main Camera");
            owner.tag = "MainCamera";
            owner.transform.position = new Vector3(0f, 1f, -10f);
            owner.AddComponent<Camera>();
            CreateMenu.CreateFirstScene(new MenuCommand(null));
            Assert.That(desk, Is.EqualTo(Describe()));
            Undo.PerformUndo();
        }

        [TestCase("Desk.unity")]
        [TestCase("Headset.unity")]
        public void CheckSceneFindsNothingToRepair(string name)
        {
            // As in the project's OpenXR settings, which the tests of the package read.
            MxInkSwitch.SwitchOn();
            ProjectScene scene = ProjectScene.Open(name);
            ProjectSettingsAsset.FindOrCreate();
            string[] findings = SceneCheck.Run().Select(finding => finding.Text).ToArray();
            Destroy(scene);
            Assert.That(findings, Is.Empty);
        }

        private static string[] DescribeTheDesk()
        {
            ProjectScene scene = ProjectScene.Open("Desk.unity");
            string[] lines = Describe();
            Destroy(scene);
            return lines;
        }

        private static void Destroy(ProjectScene scene)
        {
            foreach (GameObject each in scene.Owners.Where(each => each != null))
            {
                Object.DestroyImmediate(each);
            }
        }

        private static string[] Describe() => new[]
        {
            string.Join(", ", All<HapticSurface>().Select(each => $"{each.name} {each.Material.Label} {Place(each)}")),
            string.Join(", ", All<MousePen>().Select(each => $"{each.name} {Place(each)} {each.View}")),
            string.Join(", ", All<HapticOutput>().Select(each =>
                $"{each.name} {each.Route} {each.Channel} {each.Strength} {each.Processing.Listen}")),
            string.Join(", ", All<Camera>().Select(each => $"{each.name} {Place(each)}")),
        };

        private static string Place(Component each)
        {
            Transform place = each.transform;
            (Vector3 position, Quaternion turn, Vector3 scale) = (place.position, place.rotation, place.localScale);
            return $"{position.x:0.0000} {position.y:0.0000} {position.z:0.0000} turned {turn.x:0.0000} {turn.y:0.0000} " +
                $"{turn.z:0.0000} {turn.w:0.0000} scaled {scale.x:0.000} {scale.y:0.000} {scale.z:0.000}";
        }

        private static T[] All<T>()
            where T : Object => Object.FindObjectsByType<T>(FindObjectsInactive.Include, FindObjectsSortMode.None);
    }
}
