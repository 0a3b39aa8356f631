using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.TestTools;
using UnityShim;

namespace HaptoFlow.EditorTests
{
    /// <summary>What a build says and writes before it begins.</summary>
    public sealed class BuildTests : EditorTest
    {
        private const string Plugins = "Packages/com.haptoflow.runtime/Runtime/Plugins/";

        [SetUp]
        public void InstallALinuxAndAnAndroidLibrary()
        {
            BuildHost.ForgetPlugins();
            BuildHost.AddPlugin(Plugins + "Linux/x64/libaudioplugin_haptoflow.so", BuildTarget.StandaloneLinux64);
            BuildHost.AddPlugin(Plugins + "Android/arm64-v8a/libaudioplugin_haptoflow.so", BuildTarget.Android);
            PlayerSettings.Android.targetArchitectures = AndroidArchitecture.ARM64;
            LogAssert.ignoreFailingMessages = true;
        }

        [TearDown]
        public void UninstallThem()
        {
            BuildHost.ForgetPlugins();
            GraphicsSettings.defaultRenderPipeline = null;
            LogAssert.ignoreFailingMessages = false;
        }

        [Test]
        public void ABuildWithSettingsModelAndLibrarySaysNothing()
        {
            Settings();
            BuildHost.Preprocess(BuildTarget.StandaloneLinux64);
            BuildHost.Preprocess(BuildTarget.Android);
            Assert.That(Said(), Is.Empty);
        }

        [Test]
        public void ABuildForAPlatformWithoutLibraryIsAnErrorThatNamesTheCommandThatMakesOne()
        {
            Settings();
            BuildHost.Preprocess(BuildTarget.StandaloneWindows64);
            (LogType type, string text) = Said().Single();
            Assert.That(type, Is.EqualTo(LogType.Error));
            Assert.That(text, Does.StartWith("HaptoFlow: this build is silent on the device: "));
            Assert.That(text, Does.Contain("no library for StandaloneWindows64"));
            Assert.That(text, Does.Contain("there for: StandaloneLinux64, Android"));
            Assert.That(text, Does.Contain("npm run build -- --platform windows-x64"));
        }

        [Test]
        public void AnotherPluginOfThatPlatformDoesNotCount()
        {
            Settings();
            BuildHost.AddPlugin("Assets/Plugins/audioplugin_other.dll", BuildTarget.StandaloneWindows64);
            BuildHost.Preprocess(BuildTarget.StandaloneWindows64);
            Assert.That(Said().Single().Type, Is.EqualTo(LogType.Error));
        }

        [Test]
        public void ALibraryThatTheProjectPutElsewhereCounts()
        {
            Settings();
            BuildHost.AddPlugin("Assets/Plugins/audioplugin_haptoflow.dll", BuildTarget.StandaloneWindows64);
            BuildHost.Preprocess(BuildTarget.StandaloneWindows64);
            Assert.That(Said(), Is.Empty);
        }

        [Test]
        public void APlatformThatHaptoFlowHasNoLibraryForIsAnErrorThatSaysSo()
        {
            Settings();
            BuildHost.Preprocess(BuildTarget.WebGL);
            (LogType type, string text) = Said().Single();
            Assert.That(type, Is.EqualTo(LogType.Error));
            Assert.That(text, Does.Contain("HaptoFlow has none for this platform"));
        }

        [Test]
        public void AnAndroidBuildThatLeavesArm64OutIsAnError()
        {
            Settings();
            PlayerSettings.Android.targetArchitectures = AndroidArchitecture.ARMv7;
            BuildHost.Preprocess(BuildTarget.Android);
            Assert.That(Said().Single().Type, Is.EqualTo(LogType.Error));
            Assert.That(Said().Single().Text, Does.Contain("ARM64"));
        }

        [Test]
        public void ABuildWithoutSettingsIsWarnedOf()
        {
            PlayerSettings.SetPreloadedAssets(new Object[0]);
            BuildHost.Preprocess(BuildTarget.StandaloneLinux64);
            (LogType type, string text) = Said().Single();
            Assert.That(type, Is.EqualTo(LogType.Warning));
            Assert.That(text, Does.Contain("no HaptoFlow settings"));
        }

        [Test]
        public void ABuildWhoseSettingsAreNotPreloadedIsWarnedOf()
        {
            Settings();
            PlayerSettings.SetPreloadedAssets(new Object[0]);
            BuildHost.Preprocess(BuildTarget.StandaloneLinux64);
            Assert.That(Said().Single().Text, Does.Contain("not among the preloaded assets"));
        }

        [Test]
        public void ABuildWhoseSettingsNameNoModelIsAnError()
        {
            Settings().Model = null;
            BuildHost.Preprocess(BuildTarget.StandaloneLinux64);
            Assert.That(Said().Single(), Is.EqualTo((LogType.Error,
                "HaptoFlow: this build is silent on the device: The settings name no model: nothing is felt.")));
        }

        [Test]
        public void EverythingThatIsMissingIsSaidAtOnce()
        {
            BuildHost.ForgetPlugins();
            PlayerSettings.SetPreloadedAssets(new Object[0]);
            BuildHost.Preprocess(BuildTarget.StandaloneLinux64);
            Assert.That(Said().Select(line => line.Type), Is.EqualTo(new[] { LogType.Error, LogType.Warning }));
            Assert.That(Said()[0].Text, Does.Contain("there for: no platform"));
        }

        [TestCase(BuildTarget.Android)]
        [TestCase(null)]
        public void ASceneGoesIntoPlayersAndPlayModeWithThePipelinesMaterial(BuildTarget? platform)
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
        }

        [Test]
        public void WithTheBuiltInPipelineTheSceneStaysAsItIs()
        {
            PipelineMaterial empty = Make("Empty").AddComponent<PipelineMaterial>();
            BuildHost.ProcessScene(BuildTarget.Android);
            Assert.That(empty.Material, Is.Null);
        }

        private static (LogType Type, string Text)[] Said() => Log.Lines.ToArray();
    }
}
