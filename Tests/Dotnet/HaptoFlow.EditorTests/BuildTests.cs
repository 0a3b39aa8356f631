using System.IO;
using System.Linq;
using System.Xml.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.TestTools;
using UnityShim;

namespace HaptoFlow.EditorTests
{
    /// <summary>What the callbacks of a build log and change before it begins.</summary>
    public sealed class BuildTests : EditorTest
    {
        private const string Plugins = "Packages/com.haptoflow.runtime/Runtime/Plugins/";

        [SetUp]
        public void InstallLibraries()
        {
            BuildHost.ForgetPlugins();
            BuildHost.AddPlugin(Plugins + "Linux/x64/libaudioplugin_haptoflow.so", BuildTarget.StandaloneLinux64);
            BuildHost.AddPlugin(Plugins + "Android/arm64-v8a/libaudioplugin_haptoflow.so", BuildTarget.Android);
            PlayerSettings.Android.targetArchitectures = AndroidArchitecture.ARM64;
            LogAssert.ignoreFailingMessages = true;
        }

        [TearDown]
        public void UninstallLibraries()
        {
            BuildHost.ForgetPlugins();
            GraphicsSettings.defaultRenderPipeline = null;
            LogAssert.ignoreFailingMessages = false;
        }

        [Test]
        public void ABuildWithSettingsModelAndLibraryLogsNothing()
        {
            Settings();
            BuildHost.Preprocess(BuildTarget.StandaloneLinux64);
            BuildHost.Preprocess(BuildTarget.Android);
            Assert.That(LoggedMessages(), Is.Empty);
        }

        [TestCase(BuildTarget.StandaloneWindows64, "no library for StandaloneWindows64. There are libraries for: " +
            "StandaloneLinux64, Android. In HaptoFlow's repository, `npm run build -- --platform windows-x64`")]
        [TestCase(BuildTarget.StandaloneOSX, "`npm run build -- --platform macos` on a Mac gives it to the project there")]
        [TestCase(BuildTarget.WebGL, "HaptoFlow cannot build one for this platform")]
        public void ABuildForAPlatformWithoutLibraryLogsWhatMakesOne(BuildTarget platform, string part)
        {
            Settings();
            BuildHost.Preprocess(platform);
            (LogType type, string text) = LoggedMessages().Single();
            Assert.That(type, Is.EqualTo(LogType.Error));
            Assert.That(text, Does.StartWith("HaptoFlow: this build has no haptics: ").And.Contain(part));
        }

        [Test]
        public void ALibraryOutsideThePackageIsFoundByItsName()
        {
            Settings();
            BuildHost.AddPlugin("Assets/Plugins/audioplugin_other.dll", BuildTarget.StandaloneWindows64);
            BuildHost.Preprocess(BuildTarget.StandaloneWindows64);
            Assert.That(LoggedMessages(), Has.Length.EqualTo(1));
            Log.Clear();
            BuildHost.AddPlugin("Assets/Plugins/audioplugin_haptoflow.dll", BuildTarget.StandaloneWindows64);
            BuildHost.Preprocess(BuildTarget.StandaloneWindows64);
            Assert.That(LoggedMessages(), Is.Empty);
        }

        [Test]
        public void AnAndroidBuildWithoutArm64LogsAnError()
        {
            Settings();
            PlayerSettings.Android.targetArchitectures = AndroidArchitecture.ARMv7;
            BuildHost.Preprocess(BuildTarget.Android);
            Assert.That(LoggedMessages().Single().Type, Is.EqualTo(LogType.Error));
            Assert.That(LoggedMessages().Single().Text, Does.Contain("ARM64"));
        }

        [Test]
        public void EverythingThatIsMissingIsLoggedTogether()
        {
            BuildHost.ForgetPlugins();
            PlayerSettings.SetPreloadedAssets(new Object[0]);
            BuildHost.Preprocess(BuildTarget.StandaloneLinux64);
            Assert.That(LoggedMessages().Select(line => line.Type), Is.EqualTo(new[] { LogType.Error, LogType.Warning }));
            Assert.That(LoggedMessages()[0].Text, Does.Contain("libraries for: no platform"));
        }

        [TestCase(BuildTarget.Android)]
        [TestCase(null)]
        public void PlayersAndPlayModeGetThePipelinesMaterial(BuildTarget? platform)
        {
            var pipeline = ScriptableObject.CreateInstance<SimulatedPipeline>();
            pipeline.Material = new Material(SimulatedPipeline.ShaderNamed("Lit"));
            GraphicsSettings.defaultRenderPipeline = pipeline;
            var own = new Material(SimulatedPipeline.ShaderNamed("Chosen"));
            PipelineMaterial empty = Make("Empty", Make("Above")).AddComponent<PipelineMaterial>();
            PipelineMaterial chosen = Make("Chosen").AddComponent<PipelineMaterial>();
            chosen.Material = own;
            empty.gameObject.SetActive(false);
            BuildHost.ProcessScene(platform);
            Assert.That(empty.Material, Is.SameAs(pipeline.Material), "inactive objects as well");
            Assert.That(chosen.Material, Is.SameAs(own));
            GraphicsSettings.defaultRenderPipeline = null;
            PipelineMaterial builtIn = Make("Built-in").AddComponent<PipelineMaterial>();
            BuildHost.ProcessScene(platform);
            Assert.That(builtIn.Material, Is.Null, "the built-in pipeline has none");
        }

        private static (LogType Type, string Text)[] LoggedMessages() => Log.Lines.ToArray();
    }

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
