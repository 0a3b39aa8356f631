using System;
using System.Linq;
using HaptoFlow.SampleScenes;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>The stylus tracing sample on all outputs of the package, one after another in one scene.</summary>
    public sealed class OutputStepTests : SampleTest
    {
        private const string Right = "<XRController>{RightHand}/";

        [OneTimeSetUp]
        public void LoadOptionalAssemblies() => OptionalAssemblies.Load();

        [SetUp]
        public void BuildScene()
        {
            ForgetDevices();
            FinishLoading();
            Camera camera = CameraOf(new SceneFile("StylusTracing"));
            Wake<TracingScene>(bootstrap =>
                (bootstrap.View, bootstrap.SaveName) = (camera, ""));
        }

        [TearDown]
        public void ForgetDevices()
        {
            HeldDevices.Reset();
        }

        [Test]
        public void EveryPressSwitchesToTheNextOutputOnly()
        {
            HeldDevices.TakeTouchController();
            XrHand.Right.Take("A controller", true);
            Assert.That(Step().Text, Does.StartWith("Auto Output (O:"));
            Slide();
            Assert.That(Felt(), Is.EqualTo("waveform"), "Auto takes the best that the controller has");
            foreach ((string title, string felt) in new[]
            {
                ("Haptic Output: the audio device, as it is", "audio"),
                ("Controller Waveform Output", "waveform"),
                ("Controller Parametric Output, experimental at Meta", "parametric"),
                ("Motor Output", "motor"),
                ("Auto Output", "waveform"),
            })
            {
                Press("<Keyboard>/o");
                Assert.That(Step().Text, Does.StartWith(title));
                Slide();
                Forget();
                Slide();
                Assert.That(Felt(), Is.EqualTo(felt), title);
            }
        }

        [Test]
        public void EveryPressSwitchesToTheNextProcessingOnly()
        {
            Press("<Keyboard>/o");
            foreach ((string title, HapticEffect? running) in new (string, HapticEffect?)[]
            {
                ("as it is", null),
                ("compensated for a voice coil", HapticEffect.Compensation),
                ("100 ms later", HapticEffect.Delay),
                ("with the exposure guard", HapticEffect.ExposureGuard),
                ("as it is", null),
            })
            {
                Assert.That(Step().Text, Does.Contain(title));
                // The previous processing fades out first.
                Slide();
                HapticEffect[] processors = { HapticEffect.Compensation, HapticEffect.Delay, HapticEffect.ExposureGuard };
                ulong[] before = processors.Select(RunsOf).ToArray();
                Slide();
                for (int index = 0; index < processors.Length; ++index)
                {
                    bool ran = RunsOf(processors[index]) > before[index];
                    // A guard that was switched off measures on, so that it remembers the day.
                    bool expected = processors[index] == running ||
                        (processors[index] == HapticEffect.ExposureGuard && before[index] > 0);
                    Assert.That(ran, Is.EqualTo(expected), $"{title}: {processors[index]}");
                }
                Press("<Keyboard>/p");
            }
        }

        private static string Felt()
        {
            var felt = new[]
            {
                (Name: "audio", Is: Loudest() > Audible),
                (Name: "waveform", Is: OVRInput.Waves.Any(wave => wave.Samples.Any(sample => Math.Abs(sample) > 0.01f))),
                (Name: "parametric", Is: OVRInput.Parametric.Count > 0),
                (Name: "motor", Is: XrHand.Right.Impulses.Count > 0),
            };
            return string.Join(" and ", felt.Where(each => each.Is).Select(each => each.Name));
        }

        private static void Forget()
        {
            AudioDevice.Forget();
            OVRInput.Waves.Clear();
            OVRInput.Parametric.Clear();
            XrHand.Right.Impulses.Clear();
        }

        /// <summary>Moves the right hand to and fro on the sample's jute.</summary>
        private static void Slide()
        {
            for (int frame = 0; frame < 0.5 * World.FrameRateHz; ++frame)
            {
                float x = 0.34f + 0.02f * (float)Math.Sin(2.0 * Math.PI * 2.0 * frame / World.FrameRateHz);
                SimulatedInput.SetControl(Right + "isTracked", 1f);
                SimulatedInput.SetControl(Right + "pointerPosition", new Vector3(x, 0.013f, -0.12f));
                SimulatedInput.SetControl(Right + "pointerRotation", Quaternion.identity);
                World.Frame();
            }
            Assert.That(Pen().IsTouching, Is.True);
        }

        private static void Press(string control)
        {
            SimulatedInput.SetControl(control, 1f);
            World.Frames(2);
            SimulatedInput.SetControl(control, 0f);
            World.Frames(2);
        }

        private static ulong RunsOf(HapticEffect effect)
        {
            Assert.That(Pen().TryGetEffectStatistics(effect, out EffectStatistics statistics), Is.True);
            return statistics.Runs;
        }

        private static HapticStylus Pen() => UnityEngine.Object
            .FindObjectsByType<XrPen>(FindObjectsInactive.Exclude, FindObjectsSortMode.None)
            .Single(pen => pen.Hand == PenHand.Right).Stylus!;

        private static OutputStep Step() => UnityEngine.Object
            .FindObjectsByType<OutputStep>(FindObjectsInactive.Exclude, FindObjectsSortMode.None).Single();
    }
}
