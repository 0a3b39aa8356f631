using System.Linq;
using System.Reflection;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.ShimTests
{
    /// <summary>Which of the scene's audio outputs and of the devices in hands plays a stylus.</summary>
    public sealed class WhereStylusesPlayTests : HeldDeviceTest
    {
        private const float Audible = 0.001f;

        [SetUp]
        public void TakeAController() => OVRPlugin.Connected = OVRPlugin.Controller.RTouch;

        [Test]
        public void AnOutputOnAllChannelsLeavesAStylusToTheDeviceInItsHandAndSaysSo()
        {
            AudioTap tap = Output(out _);
            World.Frames(72);
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(60));
            Assert.That(tap.Peak(), Is.Zero);
            Assert.That(Messages("Output plays on every channel, as for loudspeakers").Single(),
                Does.Contain("Choose a channel on Output, or name it in the stylus's field Output"));
        }

        [Test]
        public void AnOutputWithAChannelTakesAStylusInAHandAndSaysSo()
        {
            AudioTap tap = Output(out HapticOutput output);
            output.Channel = 0;
            World.Frames(72);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
            Assert.That(OVRInput.Waves, Is.Empty);
            Assert.That(Messages("Stylus plays on Output and not through the device in its right hand").Single(),
                Does.Contain("Add an Auto Output to the stylus to feel it there too"));
        }

        [Test]
        public void ANamedOutputTakesAStylusInAHand()
        {
            AudioTap tap = Output(out HapticOutput output);
            Pen.Output = output;
            World.Frames(72);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
            Assert.That(OVRInput.Waves, Is.Empty);
            Pen.Output = null;
            World.Frames(72);
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(60));
        }

        [Test]
        public void ASwitchedOffOutputWithAChannelMeansSilence()
        {
            Output(out HapticOutput output);
            output.Channel = 0;
            output.enabled = false;
            World.Frames(72);
            Assert.That(OVRInput.Waves, Is.Empty);
            Assert.That(Pen.TryGetStatistics(out _), Is.False);
        }

        [TestCase(0)]
        [TestCase(1)]
        public void OfTwoOutputsTheOneWithAChannelPlaysInAnyOrder(int withChannel)
        {
            Pen.Hand = HapticHand.None;
            AudioTap[] taps = { Output(out HapticOutput first), Output(out HapticOutput second) };
            (withChannel == 0 ? first : second).Channel = 0;
            World.Frames(72);
            Assert.That(taps[withChannel].Peak(), Is.GreaterThan(Audible));
            Assert.That(taps[1 - withChannel].Peak(), Is.Zero);
        }

        [Test]
        public void APenThatIsRemovedAndAddedWhilePlayingIsFeltAgain()
        {
            Output(out _);
            World.Frames(72);
            Object.DestroyImmediate(Pen.gameObject);
            World.Frames(10);
            OVRInput.Waves.Clear();
            World.Frames(36);
            Assert.That(OVRInput.Waves, Is.Empty, "nobody touches");
            Pen = Circling();
            Pen.Hand = HapticHand.Right;
            World.Frames(72);
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(60));
            Assert.That(All<AutoOutput>(), Has.Length.EqualTo(1));
        }

        [TestCase(true)]
        [TestCase(false)]
        public void RecompilingWhilePlayingMakesNoSecondOutput(bool withDevice)
        {
            OVRPlugin.Connected = withDevice ? OVRPlugin.Controller.RTouch : OVRPlugin.Controller.None;
            World.Frames(36);
            MonoBehaviour[] made = All<AutoOutput>().Concat<MonoBehaviour>(All<HapticOutput>()).ToArray();
            Recompile();
            World.Frames(72);
            Assert.That(All<AutoOutput>().Concat<MonoBehaviour>(All<HapticOutput>()), Is.EqualTo(made));
            Assert.That(Pen.TryGetStatistics(out _), Is.True);
        }

        /// <summary>What a recompilation does to the scene: static fields and fields that cannot be serialised are
        /// empty, and scripts are disabled before it and enabled after it.</summary>
        private static void Recompile()
        {
            MonoBehaviour[] scripts = All<HapticStylus>().Concat<MonoBehaviour>(All<HapticOutput>())
                .Concat(All<AutoOutput>()).ToArray();
            foreach (MonoBehaviour script in scripts)
            {
                script.enabled = false;
            }
            foreach (HapticStylus each in All<HapticStylus>())
            {
                Private<HapticStylus>("voices").SetValue(each, null);
            }
            foreach (AutoOutput each in All<AutoOutput>())
            {
                Private<DeviceOutput>("openedFor").SetValue(each, HapticHand.None);
                Private<DeviceOutput>("attached").SetValue(each, null);
                Private<DeviceOutput>("namedIn").SetValue(each, null);
            }
            typeof(SceneOutputs).GetMethod("Forget", BindingFlags.Static | BindingFlags.NonPublic)!.Invoke(null, null);
            foreach (MonoBehaviour script in scripts)
            {
                script.enabled = true;
            }
        }

        private static FieldInfo Private<T>(string name) =>
            typeof(T).GetField(name, BindingFlags.Instance | BindingFlags.NonPublic)!;

        private static string[] Messages(string part) => Log.Lines
            .Where(line => line.Type == LogType.Log && line.Text.Contains(part)).Select(line => line.Text).ToArray();
    }
}
