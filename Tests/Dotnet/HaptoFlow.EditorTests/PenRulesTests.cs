using System.IO;
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

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
        public void DeleteTheProject() => Directory.Delete(project, true);

        [TestCase(true, false)]
        [TestCase(false, true)]
        [TestCase(true, true)]
        public void AProjectWithoutTheProfileIsToldWhereToGetIt(bool meta, bool openXr)
        {
            XrPen pen = XrPen.Create(null, PenHand.Right);
            Finding finding = PenRules.Check(new SceneContents(), MxInkSupport.Of(meta, openXr, project)).Single();
            Assert.That(finding.Severity, Is.EqualTo(MessageType.Info));
            Assert.That(finding.Text, Does.StartWith("XR Pen Right: "));
            Assert.That(finding.Text, Does.Contain("logitech.github.io/mxink").And.Contain("Input Actions"));
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

        [TestCase("MXInkProfile.cs")]
        [TestCase("Logitech MX_Ink Interaction.cs")]
        public void AFeatureForOpenXrIsFound(string name)
        {
            Directory.CreateDirectory(Path.Combine(project, "Assets", "Logitech", "Scripts"));
            File.WriteAllText(Path.Combine(project, "Assets", "Logitech", "Scripts", name), "");
            Assert.That(MxInkSupport.Of(false, true, project).IsLacking, Is.False);
            Assert.That(MxInkSupport.Of(true, false, project).IsLacking, Is.True, "Meta's SDK needs an action set");
        }

        [Test]
        public void AProjectWithoutAnSdkOrASceneWithoutPensHasNoFinding()
        {
            Assert.That(MxInkSupport.Of(false, false, project).IsLacking, Is.False);
            Assert.That(PenRules.Check(new SceneContents(), MxInkSupport.Of(true, true, project)), Is.Empty);
        }

        [TestCase("Right Hand", HapticHand.Right)]
        [TestCase("Left Hand", HapticHand.Left)]
        public void APenInNoHandIsNamedAndGetsOne(string caption, HapticHand hand)
        {
            ScenesStylus.Force = ScenesStylus.gameObject.AddComponent<Scale>();
            Repair(Only("its field Hand is None"), caption);
            Assert.That(ScenesStylus.Hand, Is.EqualTo(hand));
        }

        [Test]
        public void APenThatKnowsItsHandHasNoFinding()
        {
            XrPen pen = XrPen.Create(null, PenHand.Left);
            pen.Stylus!.Tip = pen.Stylus.transform;
            Assert.That(pen.Stylus.Hand, Is.EqualTo(HapticHand.Left), "also in edit mode");
            Assert.That(Texts(), Is.Empty);
        }

        private sealed class Scale : TipForceSource
        {
            public override bool TryRead(out float forceNewtons)
            {
                forceNewtons = 1f;
                return true;
            }
        }
    }
}
