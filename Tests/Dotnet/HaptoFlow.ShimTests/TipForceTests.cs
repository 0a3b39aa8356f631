using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.InputSystem;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    public sealed class TipForceTests : SceneTest
    {
        [Test]
        public void AnInputActionsPressureBecomesAForce()
        {
            HapticStylus stylus = PressedStylus();
            var source = stylus.gameObject.AddComponent<InputActionTipForce>();
            source.enabled = false;
            var action = new InputAction { Value = 0.25f };
            source.Pressure = new InputActionProperty(action);
            source.enabled = true;
            source.NewtonsAtFullPressure = 2f;
            stylus.Force = source;
            World.Frames(2);
            Assert.That(action.enabled, Is.True);
            Assert.That(stylus.Contact.ForceNewtons, Is.EqualTo(0.5f).Within(1e-6f));
            source.enabled = false;
            Assert.That(action.enabled, Is.False);
        }

        [Test]
        public void AMetaActionsPressureBecomesAForceAndAPenInTheAirUsesTheSpringModel()
        {
            HapticStylus stylus = PressedStylus();
            World.Frames(2);
            float spring = stylus.Contact.ForceNewtons;
            stylus.Force = stylus.gameObject.AddComponent<MetaActionTipForce>();
            OVRPlugin.Tip = 0.4f;
            World.Frames(1);
            Assert.That(stylus.Contact.ForceNewtons, Is.EqualTo(0.4f).Within(1e-6f));
            OVRPlugin.Tip = 0f;
            World.Frames(1);
            Assert.That(stylus.Contact.ForceNewtons, Is.EqualTo(spring).Within(1e-6f).And.GreaterThan(0f));
            OVRPlugin.Tip = null;
            World.Frames(1);
            Assert.That(stylus.Contact.ForceNewtons, Is.EqualTo(spring).Within(1e-6f));
        }

        [TestCase("<XRController>{RightHand}/tip", HapticHand.Right)]
        [TestCase("<XRController>{LeftHand}/tip", HapticHand.Left)]
        [TestCase("<Pen>/pressure", HapticHand.None)]
        [TestCase(null, HapticHand.None)]
        public void TheBindingOfAnInputActionSaysInWhichHandThePenIs(string? binding, HapticHand hand)
        {
            HapticStylus stylus = PressedStylus();
            var source = stylus.gameObject.AddComponent<InputActionTipForce>();
            source.Pressure = new InputActionProperty(new InputAction(binding: binding));
            stylus.Force = source;
            Assert.That(stylus.Hand, Is.EqualTo(hand));
            stylus.Hand = HapticHand.Left;
            Assert.That(stylus.Hand, Is.EqualTo(HapticHand.Left), "a hand that was set is kept");
        }

        [Test]
        public void AForceInNoHandIsNamedOnce()
        {
            HapticStylus stylus = PressedStylus();
            stylus.Force = stylus.gameObject.AddComponent<MetaActionTipForce>();
            OVRPlugin.Tip = 0.4f;
            World.Frames(90);
            Assert.That(Log.Count("no hand is known to hold it"), Is.EqualTo(1));
        }

        [TearDown]
        public void RemoveThePen() => OVRPlugin.Reset();

        private HapticStylus PressedStylus()
        {
            Board().Material.StiffnessNewtonsPerMetre = 700f;
            return Resting();
        }
    }

    /// <summary>Meta's SDK logs an error for every failing call, so it is called only when it can succeed.</summary>
    public sealed class MetaTipForceTests : SceneTest
    {
        private MetaActionTipForce source = null!;

        [SetUp]
        public void PressAPen()
        {
            OVRPlugin.Reset();
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            Board().Material.StiffnessNewtonsPerMetre = 700f;
            HapticStylus stylus = Resting();
            source = stylus.gameObject.AddComponent<MetaActionTipForce>();
            stylus.Force = source;
        }

        [TearDown]
        public void RemoveThePen() => OVRPlugin.Reset();

        [Test]
        public void AMissingActionIsQueriedOnceAndLoggedOnce()
        {
            World.Frames(90);
            Assert.That(OVRPlugin.Calls, Is.EqualTo(1));
            Assert.That(Log.Count("GetActionStateFloat", LogType.Error), Is.EqualTo(1));
            Assert.That(Log.Count("\"tip\"", LogType.Warning), Is.EqualTo(1));
        }

        [Test]
        public void WithoutASessionNothingIsQueried()
        {
            OVRPlugin.hasInputFocus = false;
            OVRPlugin.Tip = 0.4f;
            World.Frames(90);
            Assert.That(OVRPlugin.Calls, Is.Zero);
            Assert.That(Log.Count("", LogType.Error), Is.Zero);
            OVRPlugin.hasInputFocus = true;
            World.Frames(2);
            Assert.That(source.TryRead(out float newtons), Is.True);
            Assert.That(newtons, Is.EqualTo(0.4f).Within(1e-6f));
        }

        [Test]
        public void ARestartedSessionIsQueriedAgain()
        {
            World.Frames(10);
            OVRPlugin.Tip = 0.4f;
            World.Frames(10);
            Assert.That(source.TryRead(out _), Is.False, "no event has reported the change");
            OVRPlugin.hasInputFocus = false;
            World.Frames(2);
            OVRPlugin.hasInputFocus = true;
            World.Frames(2);
            Assert.That(source.TryRead(out _), Is.True);
            Assert.That(Log.Count("", LogType.Error), Is.EqualTo(1));
        }

        [Test]
        public void AConnectingPenIsQueriedAgain()
        {
            World.Frames(10);
            OVRPlugin.Tip = 0.4f;
            OVRPlugin.Connected = OVRPlugin.Controller.LTouch | OVRPlugin.Controller.RTouch;
            World.Frames(2);
            Assert.That(source.TryRead(out _), Is.True);
        }

        [Test]
        public void ANewActionNameAndAnEnabledComponentAreQueried()
        {
            World.Frames(10);
            OVRPlugin.Tip = 0.4f;
            OVRPlugin.BoundAction = "force";
            source.Action = "force";
            World.Frames(2);
            Assert.That(source.TryRead(out _), Is.True);
            OVRPlugin.BoundAction = "tip";
            World.Frames(2);
            OVRPlugin.BoundAction = "force";
            World.Frames(2);
            Assert.That(source.TryRead(out _), Is.False);
            source.enabled = false;
            source.enabled = true;
            World.Frames(2);
            Assert.That(source.TryRead(out _), Is.True);
        }
    }
}
