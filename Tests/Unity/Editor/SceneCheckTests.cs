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
        public void ACleanSceneHasNoFindingsAndIsNotChanged()
        {
            Assert.That(Texts(), Is.Empty);
            Assert.That(Object.FindObjectsByType<HapticOutput>(
                FindObjectsInactive.Include, FindObjectsSortMode.None), Has.Length.EqualTo(1));
        }

        [Test]
        public void SettingsAreAddedToThePreloadedAssets()
        {
            PlayerSettings.SetPreloadedAssets(new Object[0]);
            ProjectSettingsAsset.Forget();
            Repair(Only("not among the preloaded assets"), "Add to Preloaded Assets");
            Assert.That(ProjectSettingsAsset.IsPreloaded(ProjectSettings), Is.True);
        }

        [Test]
        public void AMissingModelIsAnErrorWithThePackagesModelAsRemedy()
        {
            ProjectSettings.Model = null;
            Finding finding = Only("have no model");
            Assert.That(finding.Severity, Is.EqualTo(MessageType.Error));
            Repair(finding, "Use the Package's Model");
            Assert.That(ProjectSettings.Model, Is.EqualTo(Model()));
        }

        [Test]
        public void ADamagedModelIsAnErrorWithItsReason()
        {
            ProjectSettings.Model = HapticModelAsset.Create(ModelBytes.Flipped(Model().File, Model().File.Length - 100));
            Assert.That(Only("cannot be used").Text, Does.Contain("checksum"));
        }

        [Test]
        public void AStylusWithoutATipGetsItsChildAsTip()
        {
            ScenesStylus.Tip = null;
            Repair(Only("has no tip"), "Use Its Child Tip");
            Assert.That(ScenesStylus.Tip!.name, Is.EqualTo("Tip"));
        }

        [Test]
        public void AStylusWithoutATipOrChildGetsANewTipInOneStepOfUndo()
        {
            Object.DestroyImmediate(ScenesStylus.Tip!.gameObject);
            ScenesStylus.Tip = null;
            Undo.IncrementCurrentGroup();
            Repair(Only("has no tip"), "Add a Tip");
            Assert.That(ScenesStylus.Tip!.parent, Is.EqualTo(ScenesStylus.transform));
            Undo.PerformUndo();
            Assert.That(ScenesStylus.Tip == null, Is.True);
            Assert.That(ScenesStylus.transform.childCount, Is.Zero);
        }

        [Test]
        public void AStylusWithoutLayersIsAnError()
        {
            ScenesStylus.Layers = 0;
            Repair(Only("has no layer"), "Feel All Layers");
            Assert.That(ScenesStylus.Layers.value, Is.EqualTo(~0));
        }

        [Test]
        public void AVeryLargeTipIsAFinding()
        {
            ScenesStylus.TipRadiusMetres = 0.05f;
            Assert.That(Only("has a radius of 50 mm").Repairs, Is.Empty);
        }

        [Test]
        public void ARigWithAScaleIsAFindingThatSaysWhatIsTheHandsAndWhatTheWorlds()
        {
            var rig = new GameObject("Giant");
            try
            {
                rig.transform.localScale = new Vector3(10f, 10f, 10f);
                ScenesStylus.Rig = rig.transform;
                Assert.That(Only("Giant, the rig of").Text, Does.Contain("a centimetre of the hand is 10 cm of the world"));
                rig.transform.localScale = Vector3.one;
                Assert.That(Texts(), Is.Empty);
            }
            finally
            {
                Object.DestroyImmediate(rig);
            }
        }

        [Test]
        public void AMissingOutputIsAdded()
        {
            Object.DestroyImmediate(ScenesOutput.gameObject);
            Undo.IncrementCurrentGroup();
            Repair(Only("has no Haptic Output"), "Add an Output");
            Undo.PerformUndo();
            Only("has no Haptic Output");
        }

        [Test]
        public void AListenerChannelWithoutAnAudioListenerIsAnError()
        {
            ScenesOutput.Route = OutputRoute.ListenerChannel;
            ScenesOutput.Channel = 1;
            Assert.That(Only("its object has no Audio Listener").Severity, Is.EqualTo(MessageType.Error));
            ScenesOutput.gameObject.AddComponent<AudioListener>();
            Assert.That(Texts(), Is.Empty);
        }

        [Test]
        public void AMixerEffectWithoutAMixerIsAnError()
        {
            ScenesOutput.Route = OutputRoute.MixerEffect;
            Assert.That(Only("its field Audio Mixer is empty").Severity, Is.EqualTo(MessageType.Error));
        }

        [Test]
        public void AChannelBeyondTheSpeakerModeIsAFinding()
        {
            ScenesOutput.Channel = 17;
            Only("plays on channel 17");
        }

        [Test]
        public void ListenBesideAnActuatorOrAChannelOfItsOwnIsAWarning()
        {
            HapticOutput output = ScenesOutput;
            output.Processing.Listen = true;
            output.Channel = HapticVoice.AllChannels;
            Assert.That(Texts(), Has.None.Contains("Listen"), "loudspeakers");
            output.Processing.Actuator = OutputActuator.VoiceCoil;
            Assert.That(Only("Listen has no effect").Severity, Is.EqualTo(MessageType.Warning));
            output.Processing.Actuator = OutputActuator.Uncompensated;
            output.Channel = 0;
            Only("Listen has no effect");
            output.Processing.Listen = false;
            Assert.That(Texts(), Has.None.Contains("Listen has no effect"));
        }

        [Test]
        public void TheMostSevereFindingComesFirst()
        {
            ScenesStylus.Layers = 0;
            ScenesStylus.Tip = null;
            Object.DestroyImmediate(ScenesOutput.gameObject);
            Assert.That(Findings().Select(finding => finding.Severity),
                Is.EqualTo(new[] { MessageType.Error, MessageType.Warning, MessageType.Info }));
        }
    }
}
