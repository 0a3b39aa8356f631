using System.IO;
using System.Linq;
using HaptoFlow.Editor;
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
}
