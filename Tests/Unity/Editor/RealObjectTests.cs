#nullable enable
using HaptoFlow.Editor;
using System.Linq;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.EditorTests
{
    public sealed class RealObjectTests : SceneCheckTest
    {
        [Test]
        public void MeasuredForceWithoutATipForceIsAFinding()
        {
            ScenesStylus.TouchBy = TouchDecision.MeasuredForce;
            Assert.That(Only("its field Tip Force is empty").Severity, Is.EqualTo(MessageType.Warning));
            ScenesStylus.Force = ScenesStylus.gameObject.AddComponent<NoForce>();
            Assert.That(Texts().Where(text => !text.Contains("its field Hand is None")), Is.Empty);
        }

        [Test]
        public void AnAlignmentWhoseMarksDetermineNoPoseIsAFinding()
        {
            var alignment = Make("Desk").AddComponent<HapticAlignment>();
            Assert.That(Texts(), Is.Empty);
            alignment.transform.localScale = new Vector3(1f, 1f, 0.01f);
            Assert.That(Only("Desk cannot be aligned").Objects, Is.EqualTo(new Object[] { alignment }));
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
        [TestCase(HapticSilence.Rest, "nothing touches")]
        [TestCase(HapticSilence.Stale, "100 ms")]
        [TestCase(HapticSilence.Muted, "muted")]
        [TestCase(HapticSilence.Paused, "paused")]
        [TestCase(HapticSilence.Panic, "next touch-down")]
        [TestCase(HapticSilence.Rate, "8000 to 192000 Hz")]
        [TestCase(HapticSilence.Closing, "closed")]
        [TestCase(HapticSilence.WorkerDead, "has ended")]
        [TestCase(HapticSilence.TurnedDown, "strength or the ceiling is 0")]
        [TestCase((HapticSilence)99, "99")]
        public void EveryReasonForSilenceIsDescribed(HapticSilence silence, string part) => Assert.That(
            SilenceWords.Of(new VoiceStatistics { Silence = silence }), Does.Contain(part));

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
