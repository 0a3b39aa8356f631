using System;
using System.Linq;
using NUnit.Framework;
using UnityEngine.InputSystem.XR;
using UnityEngine.InputSystem.XR.Haptics;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>Outputs make way for a vibration of the application's own and return.</summary>
    public sealed class YieldTests : HeldDeviceTest
    {
        [Test]
        public void AWaveformMakesWayAndReturnsWithAFade([Values] bool queued)
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            ControllerWaveformOutput output =
                Add<ControllerWaveformOutput>(made => made.QueueSubmissions = queued);
            World.Frames(72);
            int before = OVRInput.Waves.Count;
            double start = Yield(0.25f);
            World.Frames(72);
            var after = OVRInput.Waves.Skip(before).ToArray();
            Assert.That(after[0].Seconds - start, Is.InRange(0.25, 0.29));
            Assert.That(after[0].Append, Is.False);
            Assert.That(Math.Abs(after[0].Samples[0]), Is.LessThan(1e-3f), "it fades in");
            Assert.That(after.Length, Is.GreaterThan(queued ? 20 : 50));
            Assert.That(output.Statistics.Yields, Is.EqualTo(1));
            Assert.That(output.Statistics.Gaps, Is.Zero);
            Assert.That(output.Statistics.DeviceChanges, Is.Zero);
        }

        [TestCase(0u)]
        [TestCase(500u)]
        public void AMotorAndBuffersMakeWayWithoutAStop(uint bufferRateHz)
        {
            XrHand hand = XrHand.Right;
            hand.Take("A controller", true, bufferRateHz);
            World.Frames(72);
            double[] Sent() => hand.Impulses.Select(each => each.Seconds).Concat(hand.Buffers.Select(each => each.Seconds)).ToArray();
            (int before, int stops) = (Sent().Length, hand.Stops.Count);
            double start = Yield(0.25f);
            World.Frames(17);
            Assert.That(hand.Stops.Count, Is.EqualTo(stops), "a stop would end the other vibration");
            World.Frames(55);
            Assert.That(Sent()[before] - start, Is.InRange(0.25, 0.29));
            Assert.That(Sent().Length, Is.GreaterThan(before + 45));
        }

        [Test]
        public void AParametricStreamMakesWayAndBeginsAnew()
        {
            HeldDevices.TakeTouchController();
            Add<ControllerParametricOutput>(output => output.UseExperimentalFeature = true);
            World.Frames(72);
            int before = OVRInput.Parametric.Count;
            double start = Yield(0.25f);
            World.Frames(72);
            Assert.That(OVRInput.Parametric[before].Seconds - start, Is.InRange(0.25, 0.29));
            Assert.That(OVRInput.Parametric[before].Sent.StreamFrameType,
                Is.EqualTo(OVRInput.HapticsParametricStreamFrameType.FirstFrame));
        }

        [Test]
        public void OnlyTheNamedHandMakesWay([Values] HapticHand named)
        {
            OVRPlugin.Connected = OVRPlugin.Controller.Touch;
            HapticStylus left = Circling();
            left.Hand = HapticHand.Left;
            World.Frames(72);
            OVRInput.Waves.Clear();
            Haptics.Yield(named, 0.3f);
            World.Frames(20);
            Assert.That(OVRInput.Waves.Any(wave => wave.Mask == OVRInput.Controller.LTouch),
                Is.EqualTo(named == HapticHand.Right));
            Assert.That(OVRInput.Waves.Any(wave => wave.Mask == OVRInput.Controller.RTouch),
                Is.EqualTo(named == HapticHand.Left));
        }

        [Test]
        public void ImpulsesDuringImpulsesLastUntilTheLaterEnd()
        {
            PlayOnTouch();
            int before = OVRInput.Waves.Count;
            double start = Yield(0.3f);
            World.Frames(7);
            Haptics.Yield(HapticHand.Right, 0.1f);
            World.Frames(7);
            Haptics.Yield(HapticHand.Right, 0.3f);
            World.Frames(72);
            Assert.That(OVRInput.Waves[before].Seconds - start, Is.InRange(0.48, 0.54));
        }

        [Test]
        public void ADeviceThatReturnsDuringAYieldWaitsForItsEnd()
        {
            PlayOnTouch();
            double start = Yield(0.5f);
            OVRPlugin.Connected = OVRPlugin.Controller.None;
            World.Frames(10);
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            int before = OVRInput.Waves.Count;
            World.Frames(72);
            Assert.That(OVRInput.Waves[before].Seconds - start, Is.InRange(0.5, 0.56));
        }

        [Test]
        public void AnImpactDuringAYieldIsNotFeltAfterwards()
        {
            XrHand.Right.Take("A controller", true);
            Add<MotorOutput>().FullScaleMps2 = HaptoFlowSettings.Active.FullScaleMps2;
            LandInHalfASecond();
            World.Frames(36);
            Haptics.Yield(HapticHand.Right, 0.5f);
            World.Frames(72);
            Assert.That(Pen.IsTouching, Is.True);
            Assert.That(XrHand.Right.Impulses, Is.Empty, "the landing was 0.2 s before the end");
        }

        [Test]
        public void ALengthWithoutSenseDoesNotSilenceTheHand(
            [Values(0f, -1f, float.NaN, float.NegativeInfinity)] float seconds)
        {
            PlayOnTouch();
            int before = OVRInput.Waves.Count;
            Haptics.Yield(HapticHand.Right, seconds);
            World.Frames(36);
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(before + 30));
        }

        [Test]
        public void AnEndlessLengthEndsAfterAMinute()
        {
            PlayOnTouch();
            int before = OVRInput.Waves.Count;
            Haptics.Yield(HapticHand.Right, float.PositiveInfinity);
            World.Frames(59 * 72);
            Assert.That(OVRInput.Waves.Count, Is.EqualTo(before));
            World.Frames(2 * 72);
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(before));
        }

        [Test]
        public void AMuteAPanicOrAPauseMeanwhileSendsNothingToTheDevice(
            [Values("mute", "panic", "pause", "switched off")] string how)
        {
            XrHand.Right.Take("A controller", true);
            MotorOutput output = Add<MotorOutput>();
            World.Frames(72);
            int impulses = XrHand.Right.Impulses.Count;
            int stops = XrHand.Right.Stops.Count;
            Haptics.Yield(HapticHand.Right, 0.5f);
            World.Frames(2);
            Stop(output, how);
            World.Frames(72);
            Assert.That(XrHand.Right.Impulses.Count, Is.EqualTo(impulses), "and it stays silent afterwards");
            Assert.That(XrHand.Right.Stops.Count, Is.EqualTo(stops));
        }

        [Test]
        public void AnImpulseThroughTheInputSystemIsNoticed([Values] bool byCommand)
        {
            XRControllerWithRumble controller = XRControllerWithRumble.Take("Rumbling controller");
            World.Frames(72);
            int before = controller.Impulses.Count;
            double start = Clock.UnscaledSeconds;
            if (byCommand)
            {
                // As the XR Interaction Toolkit's impulse player does.
                SendHapticImpulseCommand command = SendHapticImpulseCommand.Create(0, 0.9f, 0.25f);
                Assert.That(controller.ExecuteCommand(ref command), Is.GreaterThanOrEqualTo(0L));
            }
            else
            {
                controller.SendImpulse(0.9f, 0.25f);
            }
            World.Frames(72);
            Assert.That(controller.Impulses[before].Amplitude, Is.EqualTo(0.9f), "the other impulse reached the device");
            Assert.That(controller.Impulses[before + 1].Seconds - start, Is.InRange(0.25, 0.29));
        }

        [Test]
        public void OwnImpulsesAndStopsOfOthersAreNoReasonToMakeWay()
        {
            XRControllerWithRumble controller = XRControllerWithRumble.Take("Rumbling controller");
            XRControllerWithRumble left = XRControllerWithRumble.TakeLeft("The other controller");
            MotorOutput output = Add<MotorOutput>();
            World.Frames(72);
            controller.SendImpulse(0f, 0f);
            left.SendImpulse(1f, 5f);
            World.Frames(72);
            Assert.That(output.Statistics.Yields, Is.Zero);
            Assert.That(controller.Impulses.Count, Is.GreaterThan(120));
        }

        [Test]
        public void AYieldDoesNotOutliveThePlaySession()
        {
            Haptics.Yield(HapticHand.Right, 30f);
            World.ExitPlayMode();
            World.EnterPlayMode();
            Assert.That(HandYields.UntilSeconds(HapticHand.Right), Is.Zero);
        }

        /// <summary>Makes the outputs of the right hand yield from now on, and returns the present time in seconds.</summary>
        private static double Yield(float seconds)
        {
            Haptics.Yield(HapticHand.Right, seconds);
            return Clock.UnscaledSeconds;
        }
    }
}
