using System.IO;
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEditor;
using UnityEditor.XR.OpenXR.Features;
using UnityEngine;
using UnityEngine.XR.OpenXR;
using UnityEngine.XR.OpenXR.Features;
using UnityShim;

namespace HaptoFlow.EditorTests
{
    /// <summary>Check Scene on pens: MX Ink without its interaction profile, and pens in no hand.</summary>
    public sealed class PenRulesTests : SceneCheckTest
    {
        private string project = "";

        [SetUp]
        public void MakeAProject()
        {
            project = Path.Combine(Path.GetTempPath(), "haptoflow-pens-" + Path.GetRandomFileName());
            Directory.CreateDirectory(Path.Combine(project, "Assets", "StreamingAssets"));
        }

        [TearDown]
        public void DeleteTheProject()
        {
            HeldDevices.Reset();
            Directory.Delete(project, true);
        }

        [TestCase(true, false)]
        [TestCase(false, true)]
        public void AProjectWithoutTheProfileIsToldWhereToGetIt(bool meta, bool openXr)
        {
            XrPen pen = XrPen.Create(null, PenHand.Right);
            Finding finding = PenRules.Check(new SceneContents(), MxInkSupport.Of(meta, openXr, project)).Single();
            Assert.That(finding.Severity, Is.EqualTo(MessageType.Info));
            Assert.That(finding.Text, Does.StartWith("XR Pen Right: "));
            Assert.That(finding.Text, Does.Contain("logitech.github.io/mxink").And.Contain("Input Actions")
                .And.Contain("switch on " + MxInkInteraction.DisplayName));
            Assert.That(finding.Repairs.Count, Is.EqualTo(openXr ? 1 : 0), "Meta's SDK has no switch for it");
            Assert.That(finding.Objects, Is.EqualTo(new Object[] { pen }));
        }

        [TestCase("Assets/StreamingAssets/RuntimeActionBindings.json")]
        [TestCase("RuntimeActionBindings.json")]
        public void AnActionSetOfMetasSdkIsFound(string path)
        {
            XrPen.Create(null, PenHand.Right);
            File.WriteAllText(Path.Combine(project, path), "{\"InputActionSets\": [{\"InteractionProfile\":" +
                "\"/interaction_profiles/logitech/mx_ink_stylus_logitech\"}]}");
            Assert.That(MxInkSupport.Of(true, false, project).IsLacking, Is.False);
            Assert.That(MxInkSupport.Of(false, true, project).IsLacking, Is.True, "OpenXR does not read that file");
            Assert.That(PenRules.Check(new SceneContents(), MxInkSupport.Of(true, false, project)), Is.Empty);
        }

        [Test]
        public void ActionSetsOfOtherDevicesAreNoHelp()
        {
            File.WriteAllText(Path.Combine(project, "RuntimeActionBindings.json"), "{\"InputActionSets\": []}");
            Assert.That(MxInkSupport.Of(true, false, project).IsLacking, Is.True);
        }

        [Test]
        public void TheRepairSwitchesTheProfileOnForDesktopsAndAndroid()
        {
            XrPen pen = XrPen.Create(null, PenHand.Right);
            pen.Stylus!.Tip = pen.Stylus.transform;
            Repair(Only("no interaction profile of MX Ink"), "Switch On Profile of MX Ink");
            Assert.That(OwnFeature(BuildTargetGroup.Standalone).enabled, Is.True);
            Assert.That(OwnFeature(BuildTargetGroup.Android).enabled, Is.True);
            Assert.That(OpenXRSettings.GetSettingsForBuildTargetGroup(BuildTargetGroup.Android)!
                .GetFeature<ForeignProfile>()!.enabled, Is.False, "features of other packages stay as they are");
            Undo.PerformUndo();
            Assert.That(OwnFeature(BuildTargetGroup.Standalone).enabled, Is.False, "after undo");
            Assert.That(OwnFeature(BuildTargetGroup.Android).enabled, Is.False, "after undo");
        }

        [TestCase(BuildTargetGroup.Standalone)]
        [TestCase(BuildTargetGroup.Android)]
        public void AFeatureForOpenXrIsFoundWhileItIsOn(BuildTargetGroup group)
        {
            FeatureHelpers.RefreshFeatures(group);
            Assert.That(MxInkSupport.Of(false, true, project).IsLacking, Is.True, "all features are off");
            OpenXRFeature feature = OpenXRSettings.GetSettingsForBuildTargetGroup(group)!.GetFeature<ForeignProfile>()!;
            feature.enabled = true;
            Assert.That(MxInkSupport.Of(false, true, project).IsLacking, Is.False);
            Assert.That(MxInkSupport.Of(false, true, project).CanSwitchOn, Is.False, "one profile is enough");
            Assert.That(MxInkSupport.Of(true, false, project).IsLacking, Is.True, "Meta's SDK needs an action set");
        }

        [Test]
        public void AProjectWithoutAnSdkOrASceneWithoutPensHasNoFinding()
        {
            Assert.That(MxInkSupport.Of(false, false, project).IsLacking, Is.False);
            Assert.That(PenRules.Check(new SceneContents(), MxInkSupport.Of(true, true, project)), Is.Empty);
        }

        [Test]
        public void APenThatKnowsItsHandHasNoFinding()
        {
            MxInkSwitch.SwitchOn();
            XrPen pen = XrPen.Create(null, PenHand.Left);
            pen.Stylus!.Tip = pen.Stylus.transform;
            Assert.That(pen.Stylus.Hand, Is.EqualTo(HapticHand.Left), "also in edit mode");
            Assert.That(Texts(), Is.Empty);
        }

        private static MxInkInteraction OwnFeature(BuildTargetGroup group) =>
            OpenXRSettings.GetSettingsForBuildTargetGroup(group)!.GetFeature<MxInkInteraction>()!;

        [OpenXRFeature(OpenxrExtensionStrings = MxInkFeatures.Extension)]
        private sealed class ForeignProfile : OpenXRInteractionFeature
        {
        }
    }

    /// <summary>Projects in which Disable Unity Audio is on, as FMOD and Wwise ask for.</summary>
    public sealed class UnityAudioTests : SceneCheckTest
    {
        [SetUp]
        public void SwitchUnitysAudioOff() => EditorSession.DisablesUnityAudio = true;

        [Test]
        public void CheckSceneNamesTheSettingTheOutputsThatAreSilentAndTheRemedy()
        {
            Finding finding = Only("Disable Unity Audio is on");
            Assert.That(finding.Severity, Is.EqualTo(MessageType.Error));
            Assert.That(finding.Objects, Is.EqualTo(new Object[] { ScenesOutput }));
            finding.Repairs.Single().Act();
            Assert.That(EditorSession.OpenedSettings, Is.EqualTo("Project/Audio"));
            EditorSession.DisablesUnityAudio = false;
            Assert.That(Texts(), Is.Empty);
        }

        [Test]
        public void WithoutAnOutputOnTheAudioDeviceItIsARemark()
        {
            Object.DestroyImmediate(ScenesOutput.gameObject);
            ScenesStylus.Hand = HapticHand.Right;
            Assert.That(Only("Disable Unity Audio is on").Severity, Is.EqualTo(MessageType.Info));
        }

        [Test]
        public void PlayModeSaysSoAtOnceThoughTheEditorsAudioClockRuns()
        {
            for (int round = 0; round < 2; ++round)
            {
                EditorSession.Play();
                AudioDevice.IgnoresPlay = true;
                World.Frames(3);
                Assert.That(Messages(), Has.Length.EqualTo(1));
                World.Frames(200);
                Assert.That(Messages(), Has.Length.EqualTo(1), "and nothing else afterwards");
                EditorSession.Stop();
                Output();
            }
            EditorSession.DisablesUnityAudio = false;
            EditorSession.Play();
            World.Frames(200);
            Assert.That(Messages(), Is.Empty);
        }

        private static string[] Messages() => Log.Lines.Select(line => line.Text)
            .Where(text => text.Contains("is silent")).ToArray();
    }

    /// <summary>What Check Scene says before playing is what plays, in every combination of outputs.</summary>
    public sealed class StylusPlacesPlayTests : PlayedTest
    {
        [OneTimeSetUp]
        public void LoadOptionalAssemblies() => OptionalAssemblies.Load();

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
            HapticOutput? sounding = All<HapticOutput>().SingleOrDefault(HasVoice);
            Assert.That(sounding != null && sounding.IsMade, Is.EqualTo(said.GetsMadeOutput && !playsInHand), "made");
            Assert.That(sounding == output && output != null, Is.EqualTo(said.Audio != null && !playsInHand), "audio");
            AutoOutput[] inHands = All<AutoOutput>();
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
