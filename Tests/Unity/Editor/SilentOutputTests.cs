#nullable enable
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.EditorTests
{
    public sealed class SilentOutputTests : SceneCheckTest
    {
        [Test]
        public void AListenerChannelWithoutAChannelIsAnError()
        {
            ScenesOutput.gameObject.AddComponent<AudioListener>();
            ScenesOutput.Route = OutputRoute.ListenerChannel;
            Assert.That(Only("and channel -1").Severity, Is.EqualTo(MessageType.Error));
            ScenesOutput.Channel = 1;
            Assert.That(Texts(), Is.Empty);
        }

        [Test]
        public void ADisabledOutputIsAFindingAndNoSecondOneIsOffered()
        {
            ScenesOutput.enabled = false;
            Assert.That(Only("is switched off").Repairs, Is.Empty);
        }

        [Test]
        public void AStylusWithAnInactiveOutputIsAFinding()
        {
            HapticOutput other = Output();
            other.gameObject.SetActive(false);
            ScenesStylus.Output = other;
            Assert.That(Only("which is switched off").Objects, Is.EqualTo(new Object[] { ScenesStylus, other }));
        }
    }
}
