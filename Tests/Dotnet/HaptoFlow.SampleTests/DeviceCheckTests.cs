using System;
using System.IO;
using System.Linq;
using HaptoFlow.DeviceCheck;
using HaptoFlow.SampleScenes;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>The sample Device Check from its first frame to its page, with the real library and model.</summary>
    public sealed class DeviceCheckTests : SampleTest
    {
        // They depend on the machine that runs the tests; DeviceCheckLineTests has them pass and fail.
        private static readonly string[] RealTimes =
        {
            "loading", "time for a block", "time for a segment", "worker's priority",
        };

        private DeviceCheckScene scene = null!;

        [OneTimeSetUp]
        public void LoadOptionalAssemblies() => OptionalAssemblies.Load();

        [SetUp]
        public void BuildScene()
        {
            HeldDevices.Reset();
            scene = Open<DeviceCheckScene>("DeviceCheck");
            scene.Run.Folder = folder;
        }

        [TearDown]
        public void ForgetDevices() => HeldDevices.Reset();

        [Test]
        public void AGoodDeviceAndFiveYesPassEveryLineThatIsMeasured()
        {
            XrHand.Right.Take("A controller", true);
            Play(true, true, seconds => 0.4f * (float)Math.Abs(Math.Sin(seconds)));
            Assert.That(scene.Run.Report.Lines.Where(line =>
                line.State == CheckState.Failed && !RealTimes.Contains(line.Name))
                .Select(line => $"{line.Name}: {line.Measured}"), Is.Empty);
            foreach (string name in new[]
            {
                "native library", "struct sizes", "ONNX Runtime", "labels", "tiers", "routes to devices",
                "settings and model", "callback from the library", "callbacks", "allocations", "worker",
                "late segments", "configuration", "change of configuration", "Right hand, XR impulse",
                "Right hand at rest", "Right hand pressed", "Right hand rate", "Right hand jitter",
                "pause and resume", "vibration", "stop", "evenness", "difference", "delay",
            })
            {
                Assert.That(Line(name).State, Is.EqualTo(CheckState.Passed), $"{name}: {Line(name).Measured}");
            }
            Assert.That(Line("Left hand, any route").State, Is.EqualTo(CheckState.Skipped));
            Assert.That(RealTimes.Select(name => Line(name).State), Has.None.EqualTo(CheckState.Skipped));
            string page = File.ReadAllText(Path.Combine(folder, DeviceCheckReport.PageName));
            Assert.That(scene.Run.Report.Lines.Select(line => line.Name).Where(name =>
                !page.Contains(System.Net.WebUtility.HtmlEncode(name))), Is.Empty);
            Assert.That(File.Exists(Path.Combine(folder, DeviceCheckReport.JsonName)), Is.True);
            Assert.That(scene.Words, Does.StartWith("Finished: ").And.Contain(scene.Run.PagePath));
            Assert.That(AudioDevice.Configuration.dspBufferSize, Is.EqualTo(512), "the audio device is as it was");
        }

        [Test]
        public void ADeviceThatRefusesANoisyPenAndFiveNoFailTheirLines()
        {
            XrHand.Right.Take("A controller", true, 500u);
            XrHand.Right.RefusesBuffers = true;
            Play(false, false, _ => 0.9f);
            foreach (string name in new[]
            {
                "Right hand, XR buffer", "Right hand at rest", "vibration", "stop", "evenness", "difference", "delay",
            })
            {
                Assert.That(Line(name).State, Is.EqualTo(CheckState.Failed), $"{name}: {Line(name).Measured}");
                Assert.That(Line(name).Remedy, Is.Not.Empty);
            }
            Assert.That(Line("pause and resume").State, Is.EqualTo(CheckState.Skipped));
        }

        [Test]
        public void WithoutAModelTheCheckStillEndsWithAPage()
        {
            HaptoFlowSettings.Active.Model = null;
            Haptics.Restart();
            Play(true, false, _ => 0f);
            Assert.That(Line("loading").State, Is.EqualTo(CheckState.Failed));
            Assert.That(Line("settings and model").State, Is.EqualTo(CheckState.Failed));
            Assert.That(Line("callbacks").State, Is.EqualTo(CheckState.Skipped));
            Assert.That(File.Exists(scene.Run.PagePath), Is.True);
        }

        /// <summary>A hand that does what the board says, until the page is written.</summary>
        /// <param name="answers">The answer to every question.</param>
        /// <param name="pauses">True to pause the application when asked to, false to skip.</param>
        /// <param name="press">The pressure during strokes over seconds; at rest its value at 0.</param>
        private void Play(bool answers, bool pauses, Func<double, float> press)
        {
            bool wasDown = false;
            for (int frame = 0; !scene.Run.IsFinished; ++frame)
            {
                Assert.That(frame, Is.LessThan(20000), scene.Run.Instruction);
                string words = scene.Run.Instruction;
                double seconds = frame / World.FrameRateHz;
                bool isStroking = words.StartsWith("Take it up");
                SimulatedInput.SetControl(Right + "tip", press(isStroking ? seconds : 0.0));
                Track(new Vector3(isStroking ? 0.05f * (float)Math.Sin(6.0 * seconds + 0.1) : 0f, 0.3f, 0f));
                // A press lasts a frame, and the next one begins after another.
                wasDown = scene.Run.IsAsking && !wasDown;
                SimulatedInput.SetControl(answers ? "<Keyboard>/y" : "<Keyboard>/n", wasDown ? 1f : 0f);
                bool asksForAPause = words.StartsWith("Pause");
                if (asksForAPause && pauses)
                {
                    scene.Run.SendMessage("OnApplicationPause", true);
                    World.Frame();
                    scene.Run.SendMessage("OnApplicationPause", false);
                }
                SimulatedInput.SetControl("<Keyboard>/s", asksForAPause && !pauses ? 1f : 0f);
                World.Frame();
                // The model loads and learning begins on threads of their own, beside the simulated time.
                if (words.StartsWith("Loading") || words.StartsWith("Looking"))
                {
                    System.Threading.Thread.Sleep(5);
                }
            }
            // The board shows the last words a frame later.
            World.Frame();
        }

        private CheckLine Line(string name)
        {
            CheckLine[] found = scene.Run.Report.Lines.Where(line => line.Name == name).ToArray();
            // A hand has a line in each group; here they agree.
            Assert.That(found.Select(line => line.State).Distinct().Count(), Is.EqualTo(1),
                $"{name}: {string.Join(", ", found.Select(line => $"{line.Group} {line.State}"))}");
            return found[0];
        }
    }
}
