#nullable enable
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.EditorTests
{
    public sealed class SceneCheckTests : SceneCheckTest
    {
        [Test]
        public void ACleanSceneIsCleanAndStaysAsItIs()
        {
            Assert.That(Texts(), Is.Empty);
            Assert.That(Object.FindObjectsByType<HapticOutput>(
                FindObjectsInactive.Include, FindObjectsSortMode.None), Has.Length.EqualTo(1));
        }

        [Test]
        public void SettingsOutsideThePreloadedAssetsAreGivenToPlayers()
        {
            PlayerSettings.SetPreloadedAssets(new Object[0]);
            ProjectSettingsAsset.Forget();
            Repair(Only("not among the preloaded assets"), "Add to Preloaded Assets");
            Assert.That(ProjectSettingsAsset.IsPreloaded(ProjectSettings), Is.True);
        }

        [Test]
        public void AMissingModelIsAnErrorAndThePackagesModelTheRemedy()
        {
            ProjectSettings.Model = null;
            Finding finding = Only("name no model");
            Assert.That(finding.Severity, Is.EqualTo(MessageType.Error));
            Repair(finding, "Use the Package's Model");
            Assert.That(ProjectSettings.Model, Is.EqualTo(Model()));
        }

        [Test]
        public void ADamagedModelIsAnErrorThatSaysWhy()
        {
            ProjectSettings.Model = HapticModelAsset.Create(ModelBytes.Flipped(Model().File, Model().File.Length - 100));
            Assert.That(Only("cannot be used").Text, Does.Contain("checksum"));
        }

        [Test]
        public void AStylusWithoutTipTakesItsChild()
        {
            ScenesStylus.Tip = null;
            Repair(Only("names no tip"), "Take Its Child Tip");
            Assert.That(ScenesStylus.Tip!.name, Is.EqualTo("Tip"));
        }

        [Test]
        public void AStylusWithoutTipAndChildGetsOneInOneStepOfUndo()
        {
            Object.DestroyImmediate(ScenesStylus.Tip!.gameObject);
            ScenesStylus.Tip = null;
            Undo.IncrementCurrentGroup();
            Repair(Only("names no tip"), "Add a Tip");
            Assert.That(ScenesStylus.Tip!.parent, Is.EqualTo(ScenesStylus.transform));
            Undo.PerformUndo();
            Assert.That(ScenesStylus.Tip == null, Is.True);
            Assert.That(ScenesStylus.transform.childCount, Is.Zero);
        }

        [Test]
        public void AStylusThatLooksAtNoLayerIsAnError()
        {
            ScenesStylus.Layers = 0;
            Repair(Only("looks at no layer"), "Look at All Layers");
            Assert.That(ScenesStylus.Layers.value, Is.EqualTo(~0));
        }

        [Test]
        public void ATipAsThickAsAnArmIsRemarked()
        {
            ScenesStylus.TipRadiusMetres = 0.05f;
            Assert.That(Only("has a radius of 50 mm").Repairs, Is.Empty);
        }

        [Test]
        public void AMissingOutputIsMade()
        {
            Object.DestroyImmediate(ScenesOutput.gameObject);
            Undo.IncrementCurrentGroup();
            Repair(Only("has no Haptic Output"), "Add an Output");
            Undo.PerformUndo();
            Only("has no Haptic Output");
        }

        [Test]
        public void AnOutputForAListenerThatIsNotThereIsAnError()
        {
            ScenesOutput.Route = OutputRoute.ListenerChannel;
            ScenesOutput.Channel = 1;
            Assert.That(Only("is not on an Audio Listener's object").Severity, Is.EqualTo(MessageType.Error));
            ScenesOutput.gameObject.AddComponent<AudioListener>();
            Assert.That(Texts(), Is.Empty);
        }

        [Test]
        public void AnOutputThroughNoMixerIsAnError()
        {
            ScenesOutput.Route = OutputRoute.MixerEffect;
            Assert.That(Only("names no mixer").Severity, Is.EqualTo(MessageType.Error));
        }

        [Test]
        public void AChannelBeyondTheSpeakerModeIsRemarked()
        {
            ScenesOutput.Channel = 17;
            Only("plays on channel 17");
        }

        [Test]
        public void TheWorstComesFirst()
        {
            ScenesStylus.Layers = 0;
            ScenesStylus.Tip = null;
            Object.DestroyImmediate(ScenesOutput.gameObject);
            Assert.That(Findings().Select(finding => finding.Severity),
                Is.EqualTo(new[] { MessageType.Error, MessageType.Warning, MessageType.Info }));
        }
    }
}
