using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.EditorTests
{
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
}
