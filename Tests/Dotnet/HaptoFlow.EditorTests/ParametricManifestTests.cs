using System.IO;
using System.Linq;
using System.Xml.Linq;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.EditorTests
{
    /// <summary>Meta's manifest entry of experimental features: added for parametric haptics, and for nothing else.
    /// </summary>
    public sealed class ParametricManifestTests : EditorTest
    {
        private const string Scene = "Assets/Scene.unity";
        private const string Prefab = "Assets/Output.prefab";
        private const string Empty = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<manifest " +
            "xmlns:android=\"http://schemas.android.com/apk/res/android\">\n  <application/>\n</manifest>\n";

        private string manifest = "";

        [SetUp]
        public void MakeAProject()
        {
            Directory.CreateDirectory("Gradle/src/main");
            manifest = Path.GetFullPath("Gradle/src/main/AndroidManifest.xml");
            File.WriteAllText(manifest, Empty);
            EditorBuildSettings.scenes = new[] { new EditorBuildSettingsScene(Scene, true) };
        }

        [TearDown]
        public void ForgetScenes() => EditorBuildSettings.scenes = new EditorBuildSettingsScene[0];

        [TestCase("  useExperimentalFeature: 1\n")]
        [TestCase("      propertyPath: useExperimentalFeature\n      value: 1\n")]
        public void ASceneThatPlaysParametricHapticsAddsTheEntryOnce(string line)
        {
            File.WriteAllText(Scene, "MonoBehaviour:\n" + line);
            Build();
            Build();
            XElement entry = Entries().Single();
            Assert.That(entry.Attributes().Select(each => each.Value), Is.EqualTo(
                new[] { "com.oculus.experimental.enabled", "true" }));
            Assert.That(XDocument.Load(manifest).Root!.Element("application"), Is.Not.Null, "the rest is kept");
            (LogType type, string text) = Log.Lines.Single();
            Assert.That(type, Is.EqualTo(LogType.Log));
            Assert.That(text, Does.Contain(Scene).And.Contain("store does not accept"));
        }

        [Test]
        public void APrefabOfTheSceneCounts()
        {
            File.WriteAllText(Scene, "GameObject:\n");
            File.WriteAllText(Prefab, "  useExperimentalFeature: 1\n");
            AssetDatabase.Dependencies[Scene] = new[] { Prefab, "Assets/Texture.png" };
            Build();
            Assert.That(Entries(), Has.Length.EqualTo(1));
        }

        [TestCase("  useExperimentalFeature: 0\n", true)]
        [TestCase("  queueSubmissions: 1\n", true)]
        [TestCase("  useExperimentalFeature: 1\n", false)]
        public void OtherScenesLeaveTheManifestUnchanged(string line, bool enabled)
        {
            File.WriteAllText(Scene, line);
            EditorBuildSettings.scenes = new[] { new EditorBuildSettingsScene(Scene, enabled) };
            Build();
            Assert.That(File.ReadAllText(manifest), Is.EqualTo(Empty));
            Assert.That(Log.Lines, Is.Empty);
        }

        [Test]
        public void AnEntryOfMetasSdkIsKept()
        {
            File.WriteAllText(Scene, "  useExperimentalFeature: 1\n");
            string with = Empty.Replace("<application/>", "<uses-feature " +
                "android:name=\"com.oculus.experimental.enabled\" android:required=\"true\" />");
            File.WriteAllText(manifest, with);
            Build();
            Assert.That(File.ReadAllText(manifest), Is.EqualTo(with));
            Assert.That(Log.Lines, Is.Empty);
        }

        [Test]
        public void AMissingManifestIsLoggedWithTheEntry()
        {
            File.WriteAllText(Scene, "  useExperimentalFeature: 1\n");
            File.Delete(manifest);
            Build();
            Assert.That(Log.Lines.Single().Type, Is.EqualTo(LogType.Warning));
            Assert.That(Log.Lines.Single().Text, Does.Contain("com.oculus.experimental.enabled"));
        }

        private static void Build() => BuildHost.GenerateGradleProject("Gradle");

        private XElement[] Entries() => XDocument.Load(manifest).Root!.Elements("uses-feature").ToArray();
    }
}
