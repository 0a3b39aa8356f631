using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>The XR Rig component in a scene without scripts of the user.</summary>
    public sealed class XrRigTests : SampleTest
    {
        private static readonly Vector3 CameraPosition = new Vector3(0f, 1.5f, -0.5f);
        private Camera camera = null!;

        [SetUp]
        public void AddACamera()
        {
            GameObject owner = Make("Camera");
            owner.transform.position = CameraPosition;
            owner.tag = "MainCamera";
            camera = owner.AddComponent<Camera>();
        }

        [Test]
        public void TheHeadStartsAtTheMainCamera()
        {
            Make("Rig").AddComponent<XrRig>();
            World.Frames(2);
            Assert.That(camera.transform.position, Is.EqualTo(CameraPosition), "there is no headset yet");
            SimulatedInput.SetControl("<XRHMD>/isTracked", 1f);
            SimulatedInput.SetControl("<XRHMD>/centerEyePosition", new Vector3(0.2f, 1.1f, 0.3f));
            SimulatedInput.SetControl("<XRHMD>/centerEyeRotation", Quaternion.identity);
            World.Frames(3);
            Assert.That(Vector3.Distance(camera.transform.position, CameraPosition), Is.LessThan(1e-4f));
        }

        [TestCase(0.1f)]
        [TestCase(4f)]
        public void TheHeadStartsAtTheMainCameraUnderAScaledRig(float scale)
        {
            GameObject rig = Make("Rig");
            rig.transform.localScale = new Vector3(scale, scale, scale);
            rig.AddComponent<XrRig>();
            SimulatedInput.SetControl("<XRHMD>/isTracked", 1f);
            SimulatedInput.SetControl("<XRHMD>/centerEyePosition", new Vector3(0.2f, 1.1f, 0.3f));
            SimulatedInput.SetControl("<XRHMD>/centerEyeRotation", Quaternion.identity);
            World.Frames(3);
            Assert.That(Vector3.Distance(camera.transform.position, CameraPosition), Is.LessThan(1e-4f));
        }

        [Test]
        public void APenBelowTheRigReplacesTheMousePenWhenItIsTrackedFirst()
        {
            var rig = Make("Rig").AddComponent<XrRig>();
            XrPen pen = XrPen.Create(rig.transform, PenHand.Right);
            MousePen mouse = MousePen.Create(camera);
            rig.MousePen = mouse;
            World.Frames(2);
            Assert.That(rig.PenInUse, Is.SameAs(mouse.Stylus));
            Track(1f);
            Assert.That(rig.PenInUse, Is.SameAs(pen.Stylus));
            Assert.That(mouse.gameObject.activeSelf, Is.False);
            Track(0f);
            Assert.That(rig.PenInUse, Is.SameAs(pen.Stylus), "the pen is only out of sight");
            Assert.That(mouse.gameObject.activeSelf, Is.False);
        }

        [Test]
        public void WithoutAMousePenTheRigHasAPenOnlyOnceOneIsTracked()
        {
            var rig = Make("Rig").AddComponent<XrRig>();
            XrPen pen = rig.AddPen(PenHand.Right);
            World.Frames(2);
            Assert.That(rig.PenInUse, Is.Null);
            Track(1f);
            Assert.That(rig.PenInUse, Is.SameAs(pen.Stylus));
        }

        private static void Track(float isTracked)
        {
            SimulatedInput.SetControl("<XRController>{RightHand}/isTracked", isTracked);
            SimulatedInput.SetControl("<XRController>{RightHand}/devicePosition", Vector3.zero);
            SimulatedInput.SetControl("<XRController>{RightHand}/deviceRotation", Quaternion.identity);
            World.Frames(2);
        }
    }
}
