using HaptoFlow.Project;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.XR.Management;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.SampleTests
{
    /// <summary>The headset of the project's Headset scene, on computers.</summary>
    public sealed class StartHeadsetTests : SampleTest
    {
        private XRManagerSettings manager = null!;

        private sealed class Loader : XRLoader
        {
        }

        [SetUp]
        public void ConnectAHeadset()
        {
            World.Platform = RuntimePlatform.WindowsEditor;
            manager = ScriptableObject.CreateInstance<XRManagerSettings>();
            manager.Working = ScriptableObject.CreateInstance<Loader>();
            XRGeneralSettings.Instance = ScriptableObject.CreateInstance<XRGeneralSettings>();
            XRGeneralSettings.Instance.Manager = manager;
        }

        [TearDown]
        public void Disconnect()
        {
            World.Platform = RuntimePlatform.LinuxEditor;
            XRGeneralSettings.Instance = null;
        }

        [Test]
        public void TheHeadsetStartsWithTheSceneAndStopsWithIt()
        {
            GameObject owner = Start();
            Assert.That(manager.Calls, Is.EqualTo(new[] { "initialize", "start" }));
            Object.DestroyImmediate(owner);
            Assert.That(manager.Calls, Is.EqualTo(new[] { "initialize", "start", "stop", "deinitialize" }));
        }

        [Test]
        public void WithoutAHeadsetTheSceneGoesOnAndTheConsoleSaysSoOnce()
        {
            manager.Working = null;
            GameObject owner = Start();
            World.Frames(5);
            Assert.That(manager.Calls, Is.EqualTo(new[] { "initialize" }));
            Assert.That(Log.Lines, Has.Exactly(1).Matches<(LogType Type, string Text)>(line =>
                line.Type == LogType.Log && line.Text.StartsWith("HaptoFlow: no headset answered")));
            Object.DestroyImmediate(owner);
            Assert.That(manager.Calls, Is.EqualTo(new[] { "initialize" }), "what did not start is not stopped");
        }

        [Test]
        public void AHeadsetThatRunsAlreadyIsLeftAlone()
        {
            manager.InitializeLoaderSync();
            Object.DestroyImmediate(Start());
            Assert.That(manager.Calls, Is.EqualTo(new[] { "initialize" }));
        }

        [TestCase(RuntimePlatform.Android)]
        [TestCase(RuntimePlatform.LinuxEditor)]
        [TestCase(RuntimePlatform.OSXEditor)]
        public void ElsewhereNothingIsStarted(RuntimePlatform platform)
        {
            World.Platform = platform;
            Start();
            Assert.That(manager.Calls, Is.Empty);
        }

        [Test]
        public void WithoutXrSettingsNothingHappens()
        {
            XRGeneralSettings.Instance = null;
            Start();
            Assert.That(manager.Calls, Is.Empty);
        }

        private GameObject Start()
        {
            GameObject owner = Make("Headset");
            owner.AddComponent<StartHeadset>();
            World.Frames(2);
            return owner;
        }
    }
}
