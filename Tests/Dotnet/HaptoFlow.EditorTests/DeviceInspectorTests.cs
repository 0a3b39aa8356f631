using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.EditorTests
{
    /// <summary>The Inspector of outputs for devices in a hand.</summary>
    public sealed class DeviceInspectorTests : EditorTest
    {
        [TearDown]
        public void ForgetDevices() => HeldDevices.Reset();

        [TestCase(typeof(AutoOutput))]
        [TestCase(typeof(MotorOutput))]
        [TestCase(typeof(ControllerWaveformOutput))]
        [TestCase(typeof(ControllerParametricOutput))]
        public void EveryDeviceOutputShowsItsOwnFieldsWithTheirTooltips(Type kind)
        {
            var output = (DeviceOutput)World.AddComponent(Make("Pen"), kind);
            IReadOnlyList<Drawn> drawn = InspectorTests.Draw(output);
            Assert.That(drawn.Select(item => item.Label), Is.SupersetOf(new[] { "Stylus", "Hand", "Strength", "Muted" }));
            Assert.That(drawn.Single(item => item.Label == "Hand").Tooltip, Does.Contain("whose device plays"));
            Assert.That(drawn.Select(item => item.Label), Has.None.EqualTo("Now"), "nothing plays in edit mode");
        }

        [Test]
        public void WhilePlayingItNamesDeviceFormLatencyAndGaps()
        {
            XrHand.Right.Take("Some controller", true);
            MotorOutput output = Playing();
            Assert.That(Value(output, "Device"), Is.EqualTo("Some controller, right hand"));
            Assert.That(Value(output, "Form"), Is.EqualTo("one amplitude at a time"));
            Assert.That(Value(output, "Latency"), Is.EqualTo("nothing plays"));
            Assert.That(Value(output, "Gaps"), Is.EqualTo("0"));
            Assert.That(Value(output, "Device changed"), Is.EqualTo("0 times"));
        }

        [Test]
        public void WithoutADeviceItSaysWhereItLooks()
        {
            MotorOutput output = Playing();
            Assert.That(Value(output, "Device"), Is.EqualTo("none in the right hand that takes this output"));
            output.Hand = HapticHand.None;
            Assert.That(Value(output, "Device"), Does.Contain("no hand").And.Contain("Hand"));
        }

        [Test]
        public void MutedAndPanicActWhilePlaying()
        {
            XrHand.Right.Take("Some controller", true);
            MotorOutput output = Playing();
            EditorScreen.Enter("Muted", true);
            InspectorTests.Draw(output);
            Assert.That(output.Muted, Is.True);
            EditorScreen.Press("Panic");
            Assert.DoesNotThrow(() => InspectorTests.Draw(output));
        }

        private MotorOutput Playing()
        {
            Settings();
            HapticStylus stylus = Stylus();
            MotorOutput output = stylus.gameObject.AddComponent<MotorOutput>();
            output.Hand = HapticHand.Right;
            EditorSession.Play();
            World.Frames(3);
            return output;
        }

        private static string Value(UnityEngine.Object target, string label) =>
            InspectorTests.Draw(target).Single(item => item.Label == label).Value;
    }
}
