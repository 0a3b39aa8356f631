using System;
using System.Linq;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>MX Ink through Meta's SDK: with Logitech's action set, and as the Touch controller that it is without.
    /// </summary>
    public sealed class MxInkTests : HeldDeviceTest
    {
        private static readonly Vector3 OnTheBoard = new Vector3(0.05f, 0.0015f, 0.08f);

        [Test]
        public void AnXrPenFollowsThePenAndReadsItsForceWithoutAnyScript()
        {
            Pen.enabled = false;
            XrPen pen = HeldPen(PenHand.Right);
            OVRPlugin.Tip = 0.4f;
            World.Frames(72);
            Assert.That(Vector3.Distance(pen.transform.localPosition, OnTheBoard), Is.LessThan(1e-6f));
            Assert.That(pen.Stylus!.isActiveAndEnabled, Is.True);
            Assert.That(pen.Stylus.Hand, Is.EqualTo(HapticHand.Right));
            Assert.That(pen.Stylus.Contact.ForceNewtons, Is.EqualTo(0.4f).Within(1e-5f));
            Assert.That(Log.Count("", LogType.Warning), Is.Zero);
        }

        [Test]
        public void AnXrPenIsFeltInThePensOwnMotor([Values] PenHand hand)
        {
            Pen.enabled = false;
            XrPen pen = HeldPen(hand);
            OVRPlugin.Tip = 0.4f;
            for (int frame = 0; frame < 144; ++frame)
            {
                float x = 0.05f * (float)Math.Cos(0.06 * frame);
                float z = 0.05f * (float)Math.Sin(0.06 * frame);
                Move(hand, new Vector3(x, 0.001f, z), new Quaternion(0f, 0f, 0f, 1f));
                World.Frame();
            }
            Assert.That(pen.Stylus!.IsTouching, Is.True);
            OVRPlugin.Hand expected = hand == PenHand.Left ? OVRPlugin.Hand.HandLeft : OVRPlugin.Hand.HandRight;
            Assert.That(OVRPlugin.Pulses.Count, Is.GreaterThan(60));
            Assert.That(OVRPlugin.Pulses.Select(pulse => pulse.Hand), Is.All.EqualTo(expected));
        }

        [Test]
        public void ThePensFrameIsTurnedIntoUnitys()
        {
            Pen.enabled = false;
            XrPen pen = HeldPen(PenHand.Right);
            // A quarter turn about y to the left in a right-handed frame points along -x in both.
            Move(PenHand.Right, Vector3.zero, new Quaternion(0f, (float)Math.Sqrt(0.5), 0f, (float)Math.Sqrt(0.5)));
            World.Frames(2);
            Vector3 pointing = pen.transform.localRotation * Vector3.forward;
            Assert.That(Vector3.Distance(pointing, new Vector3(-1f, 0f, 0f)), Is.LessThan(1e-5f));
        }

        [Test]
        public void APenThatIsPutAwayEndsTheTouchAndAnotherDeviceTakesOver()
        {
            Pen.enabled = false;
            XrPen pen = HeldPen(PenHand.Right);
            World.Frames(72);
            Assert.That(pen.Stylus!.IsTouching, Is.True);
            OVRPlugin.Take(OVRPlugin.Hand.HandRight, OVRPlugin.TouchPlusProfile);
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            World.Frames(144);
            Assert.That(pen.Stylus.isActiveAndEnabled, Is.False);
            SimulatedInput.SetControl("<XRController>{RightHand}/isTracked", 1f);
            SimulatedInput.SetControl("<XRController>{RightHand}/pointerPosition", new Vector3(0f, 0.2f, 0f));
            SimulatedInput.SetControl("<XRController>{RightHand}/pointerRotation", Quaternion.identity);
            World.Frames(2);
            Assert.That(pen.Stylus.isActiveAndEnabled, Is.True);
            Assert.That(pen.transform.localPosition.y, Is.EqualTo(0.2f).Within(1e-6f));
        }

        [Test]
        public void AnActionSetWithoutThePoseIsNamedOnceWithItsRemedy()
        {
            Pen.enabled = false;
            HeldPen(PenHand.Right);
            OVRPlugin.Poses.Clear();
            World.Frames(72 * 20);
            Assert.That(Log.Count("no action \"aim_right\"", LogType.Warning), Is.EqualTo(1));
            Assert.That(Log.Count("logitech.github.io/mxink", LogType.Warning), Is.EqualTo(1));
            Assert.That(OVRPlugin.FailedPoses, Is.InRange(2, 5), "each logs an error of the SDK");
        }

        [Test]
        public void AnActionSetWithoutTheForceLeavesThePoseAndTheSpringModel()
        {
            Pen.enabled = false;
            XrPen pen = HeldPen(PenHand.Right);
            World.Frames(72 * 10);
            Assert.That(pen.Stylus!.IsTouching, Is.True);
            Assert.That(pen.Stylus.Contact.ForceNewtons, Is.GreaterThan(0f));
            Assert.That(OVRPlugin.Calls, Is.InRange(1, 4));
            Assert.That(Log.Count("no action \"tip\"", LogType.Warning), Is.EqualTo(1));
        }

        [Test]
        public void TheForceOfMetasActionSaysInWhichHandThePenIs()
        {
            OVRPlugin.Take(OVRPlugin.Hand.HandLeft, OVRPlugin.MxInkProfile);
            OVRPlugin.Tip = 0.4f;
            Pen.Hand = HapticHand.None;
            Pen.Force = Pen.gameObject.AddComponent<MetaActionTipForce>();
            World.Frames(72);
            Assert.That(Pen.Hand, Is.EqualTo(HapticHand.Left));
            Assert.That(OVRPlugin.Pulses.Count, Is.GreaterThan(60));
            Assert.That(OVRPlugin.Pulses.Select(pulse => pulse.Hand), Is.All.EqualTo(OVRPlugin.Hand.HandLeft));
            OVRPlugin.Take(OVRPlugin.Hand.HandLeft, OVRPlugin.TouchPlusProfile);
            World.Frames(300);
            Assert.That(Pen.Hand, Is.EqualTo(HapticHand.Left), "the pen sleeps");
            OVRPlugin.Take(OVRPlugin.Hand.HandRight, OVRPlugin.MxInkProfile);
            World.Frames(300);
            Assert.That(Pen.Hand, Is.EqualTo(HapticHand.Right), "the user has changed the hand");
            Assert.That(OVRPlugin.Pulses[^1].Hand, Is.EqualTo(OVRPlugin.Hand.HandRight));
        }

        [Test]
        public void AStylusGivenToAnXrPenLaterGetsItsHand()
        {
            XrPen pen = XrPen.Create(null, PenHand.Left);
            Pen.Hand = HapticHand.None;
            pen.Stylus = Pen;
            Assert.That(Pen.Hand, Is.EqualTo(HapticHand.Left));
            pen.Hand = PenHand.Right;
            Assert.That(Pen.Hand, Is.EqualTo(HapticHand.Right));
            UnityEngine.Object.DestroyImmediate(pen.gameObject);
        }

        [Test]
        public void APenWithoutItsActionSetIsRecognisedAndPlaysOnItsMotor()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            OVRPlugin.Take(OVRPlugin.Hand.HandRight, OVRPlugin.TouchProfile);
            XrHand.Right.Take("Oculus Touch Controller - Right", true);
            // The force of the tip is on the stick's x axis, 1 in the air.
            OVRPlugin.MoveRightStick(1f, 0f, false);
            World.Frames(72);
            OVRInput.Waves.Clear();
            OVRPlugin.MoveRightStick(0.4f, 0f, false);
            World.Frames(72);
            Assert.That(OVRInput.Waves, Is.Empty, "nobody says that the pen plays waveforms");
            Assert.That(XrHand.Right.Impulses.Count, Is.GreaterThan(60));
            Assert.That(Log.Count("behaves like an MX Ink", LogType.Warning), Is.EqualTo(1));
            Assert.That(Log.Count("logitech.github.io/mxink", LogType.Warning), Is.EqualTo(1));
        }

        [Test]
        public void AnXrPenRecognisesAPenWithoutItsProfile()
        {
            Pen.enabled = false;
            GameObject owner = XrPen.Create(null, PenHand.Right).gameObject;
            SimulatedInput.SetControl("<XRController>{RightHand}/isTracked", 1f);
            SimulatedInput.SetControl("<XRController>{RightHand}/pointerPosition", new Vector3(0f, 0.2f, 0f));
            SimulatedInput.SetControl("<XRController>{RightHand}/pointerRotation", Quaternion.identity);
            SimulatedInput.SetControl("<XRController>{RightHand}/thumbstick", new Vector2(1f, 0f));
            SimulatedInput.SetControl("<XRController>{RightHand}/thumbstickTouched", 0f);
            World.Frames(72);
            Assert.That(Log.Count("behaves like an MX Ink", LogType.Warning), Is.EqualTo(1));
            UnityEngine.Object.DestroyImmediate(owner);
        }

        [Test]
        public void AStickIsAStick([Values("under a thumb", "at rest", "for a moment", "upwards")] string how)
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            for (int frame = 0; frame < 144; ++frame)
            {
                bool moment = frame / 20 % 2 == 0;
                OVRPlugin.MoveRightStick(how == "at rest" || (how == "for a moment" && moment) ? 0f : 1f,
                    how == "upwards" ? 0.7f : 0f, how == "under a thumb");
                World.Frame();
            }
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(120));
            Assert.That(Log.Count("MX Ink", LogType.Warning), Is.Zero);
        }

        private XrPen HeldPen(PenHand hand)
        {
            OVRPlugin.Hand held = hand == PenHand.Left ? OVRPlugin.Hand.HandLeft : OVRPlugin.Hand.HandRight;
            OVRPlugin.Take(held, OVRPlugin.MxInkProfile);
            Move(hand, OnTheBoard, new Quaternion(0f, 0f, 0f, 1f));
            XrPen pen = XrPen.Create(Make("Tracking Space").transform, hand);
            return pen;
        }

        /// <summary>Moves the pen as Meta's runtime reports it: in a right-handed frame.</summary>
        /// <param name="unity">The position in Unity's frame.</param>
        /// <param name="rightHanded">The orientation in the runtime's frame.</param>
        private static void Move(PenHand hand, Vector3 unity, Quaternion rightHanded) =>
            OVRPlugin.Poses[hand == PenHand.Left ? "aim_left" : "aim_right"] = new OVRPlugin.Posef
            {
                Position = new OVRPlugin.Vector3f { x = unity.x, y = unity.y, z = -unity.z },
                Orientation = new OVRPlugin.Quatf
                {
                    x = rightHanded.x, y = rightHanded.y, z = rightHanded.z, w = rightHanded.w,
                },
            };
    }
}
