#nullable enable
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.EditorTests
{
    /// <summary>What Check Scene says of the outputs that play each stylus.</summary>
    public sealed class StylusPlacesTests : SceneCheckTest
    {
        [Test]
        public void AHandNeedsNoAudioOutputAndNoneIsOffered()
        {
            Object.DestroyImmediate(ScenesOutput.gameObject);
            ScenesStylus.Hand = HapticHand.Left;
            Assert.That(Texts(), Is.Empty);
            Assert.That(Summary(), Is.EqualTo("Stylus is felt through the device in the left hand; until one is " +
                "connected it plays on all channels of the audio device."));
        }

        [Test]
        public void TheOfferedOutputDoesNotTakeAPenFromItsHand()
        {
            Object.DestroyImmediate(ScenesOutput.gameObject);
            HapticStylus held = Stylus();
            held.Hand = HapticHand.Right;
            Finding finding = Only("The scene has no Haptic Output for Stylus:");
            Assert.That(finding.Objects, Is.EqualTo(new[] { ScenesStylus }));
            Repair(finding, "Add an Output");
            Assert.That(Places(held).UsesHand, Is.True);
            Assert.That(Places(ScenesStylus).Audio, Is.Not.Null);
        }

        [Test]
        public void AStylusWithADeviceOutputNeedsNoAudioOutput()
        {
            Object.DestroyImmediate(ScenesOutput.gameObject);
            ScenesStylus.Hand = HapticHand.Right;
            ScenesStylus.gameObject.AddComponent<MotorOutput>();
            Assert.That(Texts(), Is.Empty);
            Assert.That(Summary(), Is.EqualTo("Stylus plays on Motor Output on Stylus (right hand)."));
        }

        [Test]
        public void APenInTheHandPlusAudioIsNamedWithBoth()
        {
            ScenesStylus.Hand = HapticHand.Right;
            ScenesStylus.Output = ScenesOutput;
            ScenesOutput.Channel = 1;
            ScenesStylus.gameObject.AddComponent<AutoOutput>().Muted = true;
            Assert.That(Summary(), Is.EqualTo("Stylus plays on Auto Output on Stylus (right hand, muted), and on Output " +
                "(channel 1 of the audio device)."));
            Assert.That(Texts(), Is.Empty);
        }

        [Test]
        public void AStylusThatCouldPlayOnTwoOutputsChoosesOneInOneStep()
        {
            HapticOutput other = Output();
            other.name = "Loudspeakers";
            Finding finding = Only("names no output, and the scene has 2 that could play it");
            Undo.IncrementCurrentGroup();
            Repair(finding, "Play on Loudspeakers (all channels)");
            Assert.That(ScenesStylus.Output, Is.EqualTo(other));
            Undo.PerformUndo();
            Assert.That(ScenesStylus.Output == null, Is.True);
        }

        [Test]
        public void AnOutputWithAChannelIsTakenBeforeOneOnAllChannels()
        {
            HapticOutput coil = Output();
            coil.Channel = 0;
            Assert.That(Texts(), Is.Empty);
            Assert.That(Places(ScenesStylus).Audio, Is.EqualTo(coil));
        }

        [Test]
        public void TwoPensInOneHandAreAFinding()
        {
            ScenesStylus.Hand = HapticHand.Right;
            HapticStylus other = Stylus();
            other.Hand = HapticHand.Right;
            Assert.That(Only("interrupts the other").Objects, Is.EquivalentTo(new[] { ScenesStylus, other }));
            other.Hand = HapticHand.Left;
            Assert.That(Texts(), Is.Empty, "two hands do not disturb each other");
        }

        [Test]
        public void TwoStylusesOfOneMixerEffectAreAFinding()
        {
            ScenesOutput.Route = OutputRoute.MixerEffect;
            Stylus();
            Assert.That(Texts(), Has.Exactly(1).Contains("the route Mixer Effect plays one stylus"));
        }

        [Test]
        public void ADeviceOutputWithoutAStylusIsAFinding()
        {
            Make("Alone").AddComponent<MotorOutput>();
            Assert.That(Only("Motor Output on Alone has no stylus").Repairs, Is.Empty);
        }

        [Test]
        public void ADeviceOutputOnAPenInsteadOfItsStylusIsPutRight()
        {
            GameObject pen = Make("Pen");
            ScenesStylus.transform.SetParent(pen.transform, false);
            ScenesStylus.Hand = HapticHand.Right;
            pen.AddComponent<AutoOutput>();
            Repair(Only("Auto Output on Pen has no stylus"), "Play Stylus");
        }

        [Test]
        public void ADeviceOutputWithoutAHandGetsOne()
        {
            var motor = ScenesStylus.gameObject.AddComponent<MotorOutput>();
            Repair(Only("Motor Output on Stylus has no hand"), "Left Hand");
            Assert.That(motor.Hand, Is.EqualTo(HapticHand.Left));
        }

        [Test]
        public void ASwitchedOffDeviceOutputThatSilencesAStylusIsAFinding()
        {
            Object.DestroyImmediate(ScenesOutput.gameObject);
            ScenesStylus.Hand = HapticHand.Right;
            var motor = ScenesStylus.gameObject.AddComponent<MotorOutput>();
            motor.enabled = false;
            Assert.That(Only("Stylus is silent: Motor Output on Stylus is switched off").Objects,
                Is.EqualTo(new Object[] { ScenesStylus, motor }));
        }

        [Test]
        public void ASwitchedOffOutputOnAllChannelsDoesNotSilenceAHand()
        {
            ScenesStylus.Hand = HapticHand.Right;
            ScenesOutput.enabled = false;
            Assert.That(Texts(), Is.Empty);
            ScenesOutput.Channel = 1;
            Only("is switched off: Stylus would play on it");
        }

        [Test]
        public void ParametricHapticsThatAreOffAreAFinding()
        {
            ScenesStylus.Hand = HapticHand.Right;
            ScenesStylus.gameObject.AddComponent<ControllerParametricOutput>();
            Only("is silent while Use Experimental Feature is off");
        }

        private static string Summary() => StylusPlaces.Summary(new SceneContents());

        private static StylusPlaces Places(HapticStylus stylus) =>
            StylusPlaces.Of(new SceneContents()).Single(each => each.Stylus == stylus);
    }
}
