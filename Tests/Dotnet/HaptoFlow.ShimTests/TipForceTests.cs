using System.Linq;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.InputSystem;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>The tip force of pens, read through optional packages.</summary>
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
            HapticSurface board = Board();
            board.Material.StiffnessNewtonsPerMetre = 700f;
            return StylusAlong(_ => new Vector3(0f, 0.001f, 0f));
        }
    }
}
