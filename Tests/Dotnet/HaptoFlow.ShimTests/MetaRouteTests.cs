using System;
using System.Linq;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>The routes to Meta's controllers: with OVRManager and without, and after calls that the runtime refused.
    /// </summary>
    public sealed class MetaRouteTests : HeldDeviceTest
    {
        [Test]
        public void WithOvrManagerInputIsUpdatedOnceAFrame()
        {
            Make("OVRManager").AddComponent<InputUpdater>();
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            World.Frames(72);
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(60));
            Assert.That(OVRInput.Updates, Is.EqualTo(72), "a second update in a frame would lose button presses");
        }

        [Test]
        public void ALastingRateOf0HertzCostsFewCallsAndLeavesTheMotorPlaying()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            OVRInput.SampleRateHz = 0f;
            XrHand.Right.Take("The same controller", true);
            World.Frames(72 * 20);
            Assert.That(OVRInput.FailedCalls, Is.InRange(5, 20));
            Assert.That(Log.Count("0 Hz", LogType.Log), Is.EqualTo(1));
            Assert.That(XrHand.Right.Impulses.Count, Is.GreaterThan(1300), "nearly every frame");
            OVRInput.SampleRateHz = 2000f;
            World.Frames(72 * 3);
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(30));
        }

        [Test]
        public void OneRefusedBufferIsFollowedByTheNextWithinATenthOfASecond()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            XrHand.Right.Take("The same controller", true);
            World.Frames(72);
            OVRInput.BuffersToRefuse = 1;
            double before = OVRInput.Waves[^1].Seconds;
            int count = OVRInput.Waves.Count;
            World.Frames(36);
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(count));
            Assert.That(OVRInput.Waves[count].Seconds - before, Is.LessThan(0.1));
            Assert.That(Log.Count("refused", LogType.Warning), Is.EqualTo(1));
        }

        [Test]
        public void BuffersRefusedForSecondsAreFollowedByWavesAndLoggedOnce()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            XrHand.Right.Take("The same controller", true);
            World.Frames(72);
            OVRInput.BuffersToRefuse = 6;
            int count = OVRInput.Waves.Count;
            int impulses = XrHand.Right.Impulses.Count;
            World.Frames(72 * 3);
            Assert.That(XrHand.Right.Impulses.Count, Is.GreaterThan(impulses + 72), "the motor plays meanwhile");
            World.Frames(72 * 3);
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(count + 72));
            Assert.That(Log.Count("refused", LogType.Warning), Is.EqualTo(1));
            Assert.That(Log.Count("is felt through", LogType.Log), Is.EqualTo(2), "once for each of the two routes");
        }

        [Test]
        public void ADeviceThatRefusesOneBufferPlaysBuffersAgain()
        {
            XrHand.Right.Take("A controller with buffers", true, 500u);
            World.Frames(72);
            XrHand.Right.RefusesBuffers = true;
            World.Frames(288);
            Assert.That(XrHand.Right.Impulses, Is.Not.Empty, "the motor plays meanwhile");
            XrHand.Right.RefusesBuffers = false;
            int count = XrHand.Right.Buffers.Count;
            World.Frames(72 * 3);
            Assert.That(XrHand.Right.Buffers.Count, Is.GreaterThan(count + 72));
            Assert.That(Log.Count("refused", LogType.Warning), Is.EqualTo(1));
        }

        [Test]
        public void WithoutASessionNothingIsCalled()
        {
            OVRPlugin.hasInputFocus = false;
            OVRPlugin.Connected = OVRPlugin.Controller.Touch;
            OVRPlugin.Take(OVRPlugin.Hand.HandRight, OVRPlugin.MxInkProfile);
            World.Frames(144);
            Assert.That(OVRInput.FailedCalls, Is.Zero);
            Assert.That(OVRPlugin.FailedPulses, Is.Zero);
            Assert.That(Log.Count("", LogType.Error), Is.Zero);
            OVRPlugin.hasInputFocus = true;
            World.Frames(72);
            Assert.That(OVRPlugin.Pulses, Is.Not.Empty);
        }

        [Test]
        public void TwoHandsPlayOnTheirOwnControllers()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.Touch;
            HapticStylus left = Circling();
            left.Hand = HapticHand.Left;
            World.Frames(72);
            Assert.That(OVRInput.Waves.Count(wave => wave.Mask == OVRInput.Controller.LTouch), Is.GreaterThan(60));
            Assert.That(OVRInput.Waves.Count(wave => wave.Mask == OVRInput.Controller.RTouch), Is.GreaterThan(60));
            OVRPlugin.Connected = OVRPlugin.Controller.LTouch;
            World.Frames(2);
            OVRInput.Waves.Clear();
            World.Frames(36);
            Assert.That(OVRInput.Waves.Select(wave => wave.Mask), Is.All.EqualTo(OVRInput.Controller.LTouch));
            Assert.That(OVRInput.Waves, Is.Not.Empty);
        }

        [Test]
        public void AnUnboundActionIsTriedSeldomAndLoggedOnce()
        {
            OVRPlugin.Take(OVRPlugin.Hand.HandRight, OVRPlugin.MxInkProfile);
            OVRPlugin.BoundHaptic = null;
            XrHand.Right.Take("MX Ink", true);
            World.Frames(72 * 20);
            Assert.That(OVRPlugin.FailedPulses, Is.InRange(2, 4), "each logs an error of the SDK");
            Assert.That(Log.Count("\"haptic_pulse\"", LogType.Warning), Is.EqualTo(1));
            Assert.That(XrHand.Right.Impulses.Count, Is.GreaterThan(1300), "the next route plays");
            OVRPlugin.BoundHaptic = "haptic_pulse";
            OVRPlugin.hasInputFocus = false;
            World.Frames(60);
            OVRPlugin.hasInputFocus = true;
            World.Frames(72);
            Assert.That(OVRPlugin.Pulses, Is.Not.Empty, "the session has been restarted");
        }

        /// <summary>What OVRManager does each frame.</summary>
        private sealed class InputUpdater : MonoBehaviour
        {
            private void Update() => OVRInput.Update();
        }
    }
}
