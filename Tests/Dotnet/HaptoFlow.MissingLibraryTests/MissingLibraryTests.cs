using System.Linq;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.MissingLibraryTests
{
    public sealed class MissingLibraryTests : SceneTest
    {
        [Test]
        public void TheSceneRunsOnAndOneErrorNamesThePackagesToInstall()
        {
            Board();
            AudioTap tap = Output(out HapticOutput output);
            HapticStylus stylus = StylusAlong(seconds =>
                new Vector3(0f, seconds > 0.2 && seconds < 0.4 ? 0.1f : 0.001f, 0f));
            var log = new TouchLog(stylus);
            FinishLoading();
            World.Frames(60);
            Assert.That(log.Began, Is.EqualTo(2));
            Assert.That(tap.Blocks, Is.GreaterThan(0));
            Assert.That(tap.Peak(), Is.Zero);
            Assert.That(Haptics.IsReady, Is.False);
            string[] errors = Log.Lines.Where(line => line.Type == LogType.Error).Select(line => line.Text).ToArray();
            Assert.That(errors, Has.Length.EqualTo(1));
            Assert.That(errors[0], Does.Contain("runs without haptics").And.Contain("com.github.asus4.onnxruntime"));
            output.Muted = true;
            output.Panic();
            Haptics.Panic();
        }

        [Test]
        public void TheHeaderOfAModelSaysWhyItCannotBeRead()
        {
            var refusal = Assert.Throws<HaptoFlowException>(() => _ = DefaultModel.Asset().Header);
            Assert.That(refusal!.Status, Is.EqualTo(HaptoFlowStatus.LibraryUnavailable));
            Assert.That(refusal.Message, Does.Contain("install the packages"));
        }

        [Test]
        public void TheBindingReportsAMissingLibrary()
        {
            var refusal = Assert.Throws<HaptoFlowException>(() => OnnxRuntime.LibraryVersion());
            Assert.That(refusal!.Status, Is.EqualTo(HaptoFlowStatus.LibraryUnavailable));
            refusal = Assert.Throws<HaptoFlowException>(() => HapticModel.Open(DefaultModel.Asset().File));
            Assert.That(refusal!.Status, Is.EqualTo(HaptoFlowStatus.LibraryUnavailable));
        }
    }
}
