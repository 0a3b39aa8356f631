#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.EditorTests
{
    public sealed class SceneCheckTests : SceneCheckTest
    {
        /// <summary>What is wrong, and what Check Scene finds: a part of its text, its severity, the caption of the
        /// repair that is pressed ("" for none), and whether one undo brings the fault back.</summary>
        private static IEnumerable<TestCaseData> Faults()
        {
            TestCaseData Fault(string name, Action<SceneCheckTests> make, string part, MessageType severity,
                string repair = "", bool undoes = true) =>
                new TestCaseData(make, part, severity, repair, undoes).SetName("{m}(" + name + ")");

            yield return Fault("not preloaded", _ =>
            {
                PlayerSettings.SetPreloadedAssets(new Object[0]);
                ProjectSettingsAsset.Forget();
            }, "not among the preloaded assets", MessageType.Warning, "Add to Preloaded Assets", false);
            yield return Fault("no model", test => test.ProjectSettings.Model = null, "have no model",
                MessageType.Error, "Use the Package's Model");
            yield return Fault("damaged model", test => test.ProjectSettings.Model = HapticModelAsset.Create(
                ModelBytes.Flipped(Model().File, Model().File.Length - 100)), "checksum", MessageType.Error);

            yield return Fault("no tip", test => test.ScenesStylus.Tip = null, "has no tip", MessageType.Warning,
                "Use Its Child Tip");
            yield return Fault("no child Tip", test => Object.DestroyImmediate(test.ScenesStylus.Tip!.gameObject),
                "has no tip", MessageType.Warning, "Add a Tip");
            yield return Fault("no layer", test => test.ScenesStylus.Layers = 0, "has no layer", MessageType.Error,
                "Feel All Layers");
            yield return Fault("large tip", test => test.ScenesStylus.TipRadiusMetres = 0.05f,
                "has a radius of 50 mm", MessageType.Warning);
            yield return Fault("large rig", test =>
            {
                test.ScenesStylus.Rig = test.Make("Giant").transform;
                test.ScenesStylus.Rig.localScale = new Vector3(10f, 10f, 10f);
            }, "has the scale 10: a centimetre of the hand is 10 cm of the world", MessageType.Info);
            yield return Fault("no force", test => test.ScenesStylus.TouchBy = TouchDecision.MeasuredForce,
                "its field Tip Force is empty", MessageType.Warning);
            yield return Fault("right hand", test => test.AddForce(), "its field Hand is None", MessageType.Info,
                "Right Hand");
            yield return Fault("left hand", test => test.AddForce(), "its field Hand is None", MessageType.Info,
                "Left Hand");
            yield return Fault("flat marks", test => test.Make("Desk").AddComponent<HapticAlignment>()
                .transform.localScale = new Vector3(1f, 1f, 0.01f), "Desk cannot be aligned", MessageType.Warning);

            yield return Fault("no output", test => Object.DestroyImmediate(test.ScenesOutput.gameObject),
                "has no Haptic Output for Stylus:", MessageType.Info, "Add an Output");
            yield return Fault("no Audio Listener", test => test.Listen(1, false), "its object has no Audio Listener",
                MessageType.Error);
            yield return Fault("no channel", test => test.Listen(-1, true), "and channel -1", MessageType.Error);
            yield return Fault("no mixer", test => test.ScenesOutput.Route = OutputRoute.MixerEffect,
                "its field Audio Mixer is empty", MessageType.Error);
            yield return Fault("high channel", test => test.ScenesOutput.Channel = 17, "plays on channel 17",
                MessageType.Warning);
            yield return Fault("output off", test => test.ScenesOutput.enabled = false, "is switched off",
                MessageType.Warning);
            yield return Fault("named output off", test =>
            {
                test.ScenesStylus.Output = test.Output();
                test.ScenesStylus.Output!.gameObject.SetActive(false);
            }, "which is switched off", MessageType.Warning);
            yield return Fault("two outputs", test => test.Output().name = "Loudspeakers",
                "names no output, and the scene has 2 that could play it", MessageType.Warning,
                "Play on Loudspeakers (all channels)");

            yield return Fault("no stylus", test => test.Make("Alone").AddComponent<MotorOutput>(),
                "Motor Output on Alone has no stylus", MessageType.Warning);
            yield return Fault("output of a pen", test =>
            {
                GameObject pen = test.Make("Pen");
                test.ScenesStylus.transform.SetParent(pen.transform, false);
                test.ScenesStylus.Hand = HapticHand.Right;
                pen.AddComponent<AutoOutput>();
            }, "Auto Output on Pen has no stylus", MessageType.Warning, "Play Stylus");
            yield return Fault("no hand", test => test.ScenesStylus.gameObject.AddComponent<MotorOutput>(),
                "Motor Output on Stylus has no hand", MessageType.Warning, "Left Hand");
            yield return Fault("motor off", test =>
            {
                Object.DestroyImmediate(test.ScenesOutput.gameObject);
                test.InHand<MotorOutput>().enabled = false;
            }, "Stylus is silent: Motor Output on Stylus is switched off", MessageType.Warning);
            yield return Fault("parametric off", test => test.InHand<ControllerParametricOutput>(),
                "is silent while Use Experimental Feature is off", MessageType.Warning);
            yield return Fault("two pens", test =>
            {
                test.ScenesStylus.Hand = HapticHand.Right;
                test.Stylus().Hand = HapticHand.Right;
            }, "interrupts the other", MessageType.Warning);

            yield return Fault("unknown label", test => test.Tagged("Shelf", "plywod"), "has no label \"plywod\"",
                MessageType.Warning, "Use \"plywood\"");
            yield return Fault("unknown second label", test =>
                test.Tagged("Shelf", "wood").Material.SecondLabel = "asbestos", "its labels are: wood, plywood",
                MessageType.Warning);
            yield return Fault("no label", test => test.Tagged("Shelf", ""), "Shelf has no label", MessageType.Warning);
            yield return Fault("no collider", test => test.Make("Ghost").AddComponent<HapticSurface>(),
                "Ghost is tagged, but has no collider", MessageType.Warning);
            yield return Fault("not tagged", test => test.Box("Steel Door"),
                "Steel Door is not tagged; its name suggests metal", MessageType.Info, "Tag as metal");
            yield return Fault("no mesh", test => test.Tagged("Vase", "wood").gameObject.AddComponent<MeshCollider>(),
                "have no mesh", MessageType.Warning);
            yield return Fault("65 learnt materials", test => Array.ForEach(new int[65], _ =>
                test.Tagged("Bottle", "wood").SharedMaterial = HapticMaterial.Create(Glass(), "wood")),
                "use 65 learnt materials, but an engine takes at most 64", MessageType.Warning);
        }

        [TestCaseSource(nameof(Faults))]
        public void AFaultIsTheOnlyFindingAndItsRepairEndsIt(Action<SceneCheckTests> make, string part,
            MessageType severity, string repair, bool undoes)
        {
            Assert.That(Texts(), Is.Empty, "the scene is clean");
            make(this);
            Finding finding = Only(part);
            Assert.That(finding.Severity, Is.EqualTo(severity));
            if (repair.Length == 0)
            {
                return;
            }
            Undo.IncrementCurrentGroup();
            Repair(finding, repair);
            if (undoes)
            {
                Undo.PerformUndo();
                Only(part);
            }
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

        [Test]
        public void ListenBesideAnActuatorOrAChannelOfItsOwnIsAWarning()
        {
            ScenesOutput.Processing.Listen = true;
            ScenesOutput.Channel = HapticVoice.AllChannels;
            Assert.That(Texts(), Is.Empty, "loudspeakers");
            ScenesOutput.Processing.Actuator = OutputActuator.VoiceCoil;
            Assert.That(Only("Listen has no effect").Severity, Is.EqualTo(MessageType.Warning));
            ScenesOutput.Processing.Actuator = OutputActuator.Uncompensated;
            ScenesOutput.Channel = 0;
            Only("Listen has no effect");
        }

        [Test]
        public void TwoStylusesOfOneMixerEffectAreAFinding()
        {
            ScenesOutput.Route = OutputRoute.MixerEffect;
            Stylus();
            Assert.That(Texts(), Has.Exactly(1).Contains("the route Mixer Effect plays one stylus"));
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
        public void AMaterialOfSeveralSurfacesIsOneFinding()
        {
            HapticMaterial shared = ScriptableObject.CreateInstance<HapticMaterial>();
            shared.name = "Bark";
            shared.Description.Label = "wod";
            HapticMaterial foreign = HapticMaterial.Create(Glass().Replace(Model().Header.Space, "0badcafe"), "wood");
            foreign.name = "Foreign";
            foreach (string name in new[] { "Shelf", "Bench" })
            {
                Tagged(name, "wood").SharedMaterial = shared;
            }
            Repair(Only("Bark: the model has no label \"wod\""), "Use \"wood\"");
            Tagged("Jar", "wood").SharedMaterial = foreign;
            Tagged("Cup", "wood").Material.Learnt = foreign;
            Finding finding = Only("Foreign is felt as its label \"wood\": it was learnt for another model");
            Assert.That(finding.Text, Does.Contain("Learn it again"));
            Assert.That(finding.Objects, Is.EqualTo(new Object[] { foreign }));
        }

        [Test]
        public void UntaggedCollidersWithoutAProposalAreOneFinding()
        {
            for (int index = 0; index < 10; ++index)
            {
                Box("Thing " + index).layer = 4;
            }
            Finding finding = Only("no name suggests a label");
            Assert.That(finding.Objects, Has.Count.EqualTo(10));
            Assert.That(finding.Text, Does.EndWith("Thing 7 and 2 more."));
            ScenesStylus.Layers = ~(1 << 4);
            Assert.That(Texts(), Is.Empty, "no stylus feels this layer");
        }

        [Test]
        public void AMeshThatIsNotConvexIsAFindingWithItsLimits()
        {
            var mesh = Make("Vase").AddComponent<MeshCollider>();
            mesh.gameObject.AddComponent<HapticSurface>();
            mesh.sharedMesh = new Mesh
            {
                vertices = new[] { Vector3.zero, Vector3.right, Vector3.up, Vector3.forward },
                triangles = new[] { 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3 },
            };
            Assert.That(Only("are not convex").Text, Does.Contain("20 mm").And.Contain("Vase"));
            mesh.convex = true;
            Assert.That(Texts(), Is.Empty);
        }

        [Test]
        public void TheSummarySaysWhatPlaysEachStylus()
        {
            ScenesStylus.Hand = HapticHand.Right;
            ScenesStylus.Output = ScenesOutput;
            ScenesOutput.Channel = 1;
            InHand<AutoOutput>().Muted = true;
            Assert.That(Summary(), Is.EqualTo("Stylus plays on Auto Output on Stylus (right hand, muted), and on Output " +
                "(channel 1 of the audio device)."));
            Object.DestroyImmediate(ScenesStylus.GetComponent<AutoOutput>());
            Object.DestroyImmediate(ScenesOutput.gameObject);
            Assert.That(Summary(), Is.EqualTo("Stylus is felt through the device in the right hand; until one is " +
                "connected it plays on all channels of the audio device."));
            InHand<MotorOutput>();
            Assert.That(Summary(), Is.EqualTo("Stylus plays on Motor Output on Stylus (right hand)."));
            Assert.That(Texts(), Is.Empty);
        }

        [Test]
        public void TheOfferedOutputDoesNotTakeAPenFromItsHand()
        {
            Object.DestroyImmediate(ScenesOutput.gameObject);
            HapticStylus held = Stylus();
            held.Hand = HapticHand.Right;
            Repair(Only("The scene has no Haptic Output for Stylus:"), "Add an Output");
            Assert.That(Places(held).UsesHand, Is.True);
            Assert.That(Places(ScenesStylus).Audio, Is.Not.Null);
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
        public void AMissingVoiceNamesTheOutputThatIsSwitchedOff()
        {
            Assert.That(SilenceWords.OfMissingVoice(ScenesStylus), Is.EqualTo("none yet"));
            ScenesStylus.Output = ScenesOutput;
            ScenesOutput.enabled = false;
            Assert.That(SilenceWords.OfMissingVoice(ScenesStylus), Is.EqualTo("none: Output is switched off"));
            ScenesOutput.enabled = true;
            ScenesStylus.enabled = false;
            Assert.That(SilenceWords.OfMissingVoice(ScenesStylus), Does.Contain("stylus is switched off"));
        }

        [TestCase(HapticSilence.None, "plays")]
        [TestCase(HapticSilence.Stale, "100 ms")]
        [TestCase(HapticSilence.Panic, "next touch-down")]
        [TestCase(HapticSilence.Rate, "8000 to 192000 Hz")]
        [TestCase(HapticSilence.TurnedDown, "strength or the ceiling is 0")]
        [TestCase((HapticSilence)99, "99")]
        public void AReasonForSilenceIsDescribed(HapticSilence silence, string part) => Assert.That(
            SilenceWords.Of(new VoiceStatistics { Silence = silence }), Does.Contain(part));

        private static string Glass() => HaptoFlow.Model.MaterialText.OfLabel(Model().File, "glass");

        private static string Summary() => StylusPlaces.Summary(new SceneContents());

        private static StylusPlaces Places(HapticStylus stylus) =>
            StylusPlaces.Of(new SceneContents()).Single(each => each.Stylus == stylus);

        private T InHand<T>()
            where T : DeviceOutput
        {
            ScenesStylus.Hand = HapticHand.Right;
            return ScenesStylus.gameObject.AddComponent<T>();
        }

        private void AddForce() => ScenesStylus.Force = ScenesStylus.gameObject.AddComponent<NoForce>();

        private void Listen(int channel, bool atListener)
        {
            ScenesOutput.Route = OutputRoute.ListenerChannel;
            ScenesOutput.Channel = channel;
            if (atListener)
            {
                ScenesOutput.gameObject.AddComponent<AudioListener>();
            }
        }

        private sealed class NoForce : TipForceSource
        {
            public override bool TryRead(out float forceNewtons)
            {
                forceNewtons = 0f;
                return false;
            }
        }
    }
}
