extern alias Legacy;

using System.Linq;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;
using UnityShim;
using LegacyButton = Legacy::HaptoFlow.ButtonPress;
using LegacyScene = Legacy::HaptoFlow.SampleScenes.TracingScene;
using LegacyXrPen = Legacy::HaptoFlow.XrPen;

namespace HaptoFlow.SampleTests
{
    /// <summary>The samples in a project with the old Input Manager.</summary>
    public sealed class LegacyInputTests : SampleTest
    {
        [Test]
        public void TheOldInputManagersMouseMovesThePen()
        {
            FinishLoading();
            camera = CameraOf(new SceneFile("StylusTracing"));
            var scene = Wake<LegacyScene>(bootstrap => bootstrap.View = camera);
            Press(new Vector3(0.34f, 0.012f, -0.12f), 0.4);
            Assert.That(scene.Pen.Stylus.IsTouching, Is.True);
            Assert.That(scene.Pen.Stylus.Contact.Material!.Label, Is.EqualTo("jute"));
        }

        [Test]
        public void TheOldInputManagersKeysAnswerTheDelayStudy()
        {
            using var yes = new LegacyButton("<Keyboard>/y", "<XRController>{LeftHand}/triggerPressed");
            using var no = new LegacyButton("<Keyboard>/n", "<XRController>{LeftHand}/gripPressed");
            Assert.That(LegacyButton.Answer(yes, no), Is.Null);
            SimulatedInput.KeyDown = KeyCode.Y;
            Assert.That(LegacyButton.Answer(yes, no), Is.True);
            SimulatedInput.KeyDown = KeyCode.N;
            Assert.That(LegacyButton.Answer(yes, no), Is.False);
        }

        [Test]
        public void AnXrPenWithoutTheInputSystemIsInactiveAndLogsWhy()
        {
            LogAssert.ignoreFailingMessages = true;
            LegacyXrPen pen = LegacyXrPen.Create(null, Legacy::HaptoFlow.PenHand.Left);
            World.Frames(3);
            Assert.That(pen.Stylus!.isActiveAndEnabled, Is.False);
            Assert.That(pen.Hand, Is.EqualTo(Legacy::HaptoFlow.PenHand.Left));
            Assert.That(Log.Lines.Count(line => line.Text.Contains("does not use the Input System")), Is.EqualTo(1));
        }
    }
}
