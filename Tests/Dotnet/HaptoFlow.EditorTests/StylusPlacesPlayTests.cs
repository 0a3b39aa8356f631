using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.EditorTests
{
    /// <summary>What Check Scene says before playing is what plays, in every combination of outputs.</summary>
    public sealed class StylusPlacesPlayTests : EditorTest
    {
        [OneTimeSetUp]
        public void LoadOptionalAssemblies() => OptionalAssemblies.Load();

        [SetUp]
        public void StepTheEngine()
        {
            HeldDevices.Reset();
            HapticSession.OptionsOverride = new HapticEngineOptions { WithoutWorker = true, FixedLeadMs = 8.0, Seed = 3 };
        }

        [TearDown]
        public void Forget()
        {
            HapticSession.OptionsOverride = null;
            HeldDevices.Reset();
        }

        [Test, Pairwise]
        public void WhatCheckSceneSaysIsWhatPlays(
            [Values] bool inHand, [Values("none", "all", "channel", "all off", "channel off")] string audio,
            [Values("none", "on", "off")] string device, [Values] bool isNamed, [Values] bool isConnected)
        {
            Settings().Quality = HapticQuality.Draft;
            Make("Listener").AddComponent<AudioListener>();
            HapticStylus stylus = Stylus();
            stylus.Hand = inHand ? HapticHand.Right : HapticHand.None;
            HapticOutput? output = null;
            if (audio != "none")
            {
                output = Output();
                output.Channel = audio.StartsWith("channel") ? 1 : -1;
                output.enabled = !audio.EndsWith("off");
                stylus.Output = isNamed ? output : null;
            }
            if (device != "none")
            {
                stylus.gameObject.AddComponent<AutoOutput>().enabled = device == "on";
            }
            OVRPlugin.Connected = isConnected ? OVRPlugin.Controller.RTouch : OVRPlugin.Controller.None;
            StylusPlaces said = StylusPlaces.Of(new SceneContents()).Single();

            EditorSession.Play();
            HapticSession.Current.FinishLoading();
            World.Frames(5);

            bool playsInHand = said.UsesHand && isConnected;
            HapticOutput? sounding = Object.FindObjectsByType<HapticOutput>(
                FindObjectsInactive.Include, FindObjectsSortMode.None).SingleOrDefault(HasVoice);
            Assert.That(sounding != null && sounding.IsMade, Is.EqualTo(said.GetsMadeOutput && !playsInHand), "made");
            Assert.That(sounding == output && output != null, Is.EqualTo(said.Audio != null && !playsInHand), "audio");
            AutoOutput[] inHands = Object.FindObjectsByType<AutoOutput>(
                FindObjectsInactive.Include, FindObjectsSortMode.None);
            Assert.That(inHands.Any(each => each.IsMade), Is.EqualTo(said.UsesHand), "chosen");
            Assert.That(inHands.Any(each => !each.IsMade && each.isActiveAndEnabled), Is.EqualTo(said.Devices.Count > 0));
            Assert.That(stylus.TryGetStatistics(out _), Is.EqualTo(!said.IsSilent), "silent");
        }

        private static bool HasVoice(HapticOutput output)
        {
            int voices = 0;
            output.ForEachVoice((_, __) => ++voices, 0);
            return voices > 0;
        }
    }
}
