using System;
using System.Globalization;
using System.IO;
using System.Linq;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.XR.OpenXR.Input;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.ShimTests
{
    /// <summary>The haptics that devices in a hand receive while a stylus slides over a board.</summary>
    public sealed class DeviceOutputTests : HeldDeviceTest
    {
        [Test]
        public void AutoOutputPlaysTheWaveformOnATouchController()
        {
            PlayOnTouch();
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(60));
            Assert.That(OVRInput.Waves.All(wave => wave.Mask == OVRInput.Controller.RTouch && wave.RateHz == 2000f));
            Assert.That(OVRInput.Waves.Max(wave => wave.Samples.Max(Math.Abs)), Is.GreaterThan(0.01f));
            Assert.That(All<HapticOutput>(), Is.Empty, "no audio output is made");
            Assert.That(Log.Count("the scene assigns no output, and Auto Output plays the waveform", LogType.Log), Is.EqualTo(1));
            Assert.That((OVRInput.FailedCalls, OVRInput.Updates), Is.EqualTo((0, 0)), "without OVRManager");
        }

        [Test]
        public void AControllerWithoutWaveformsPlaysAmplitudes()
        {
            XrHand.Right.Take("Some controller", true);
            World.Frames(72);
            Assert.That(XrHand.Right.Impulses.Count, Is.InRange(60, 73));
            Assert.That(XrHand.Right.Impulses.Max(each => each.Amplitude), Is.GreaterThan(0.01f));
            Assert.That(XrHand.Right.Impulses.Max(each => each.Duration), Is.LessThanOrEqualTo(0.1f));
            Assert.That(XrHand.Left.Impulses, Is.Empty);
            Assert.That(Log.Count("Some controller (Right hand)", LogType.Log), Is.EqualTo(1));
        }

        [Test]
        public void AControllerThatSupportsBuffersGetsTheWaveAtItsOwnRate()
        {
            XrHand.Right.Take("A controller with buffers", true, 500u);
            World.Frames(145);
            double first = XrHand.Right.Buffers[0].Seconds;
            double last = XrHand.Right.Buffers[^1].Seconds;
            int samples = XrHand.Right.Buffers.Sum(each => each.Bytes.Length);
            // Aligning with the clock sends the buffered samples again, about twice a second.
            Assert.That(samples, Is.EqualTo(500.0 * (last - first)).Within(80.0));
            Assert.That(XrHand.Right.Buffers.Max(each => each.Bytes.Max()), Is.GreaterThan(2));
            Assert.That(XrHand.Right.Impulses, Is.Empty);
        }

        [Test]
        public void SubmissionsQueueWhenTheAuthorChoosesIt()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            Add<ControllerWaveformOutput>(output => output.QueueSubmissions = true);
            World.Frames(145);
            // Aligning with the clock sends the buffered samples again, about twice a second.
            Assert.That(OVRInput.Waves.Count(wave => !wave.Append), Is.InRange(2, 8));
            Assert.That(OVRInput.Waves.Sum(wave => wave.Samples.Length), Is.EqualTo(4000).Within(330));
        }

        [Test]
        public void AStylusPlaysOnTheAudioDeviceUntilTheDeviceInItsHandConnects()
        {
            World.Frames(3);
            Assert.That(All<HapticOutput>(), Has.Length.EqualTo(1));
            World.Frames(100);
            Assert.That(Pen.TryGetStatistics(out _), Is.True);
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            World.Frames(80);
            Assert.That(OVRInput.Waves, Is.Not.Empty, "a device that connects later is used");
        }

        [Test]
        public void AnAudioOutputWithAChannelAddedLaterReplacesAutoOutput()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            World.Frames(40);
            AudioTap tap = Output(out HapticOutput output);
            output.Channel = 0;
            World.Frames(2);
            int before = OVRInput.Waves.Count;
            World.Frames(40);
            Assert.That(OVRInput.Waves.Count, Is.EqualTo(before));
            Assert.That(tap.Peak(), Is.GreaterThan(0.001f));
            Assert.That(All<AutoOutput>(), Is.Empty);
        }

        [Test]
        public void AutoOutputIsNotAddedWhenAnOutputNamesTheStylus()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            MotorOutput motor = Add<MotorOutput>();
            World.Frames(10);
            motor.enabled = false;
            World.Frames(300);
            Assert.That(All<HapticOutput>(), Is.Empty);
            Assert.That(All<AutoOutput>(), Is.Empty);
            Assert.That(Pen.TryGetStatistics(out _), Is.False, "a stylus that cannot be felt has no voice");
        }

        [Test]
        public void TheOpenXrActionTakesPrecedenceOverTheImpulse()
        {
            XrHand.Right.Take("A controller", true);
            SimulatedInput.SetControl("<XRController>{RightHand}/haptic", 0f);
            OpenXRInput.Handle = 7uL;
            World.Frames(72);
            Assert.That(OpenXRInput.Impulses.Count, Is.GreaterThan(60));
            Assert.That(OpenXRInput.Impulses.Select(each => each.FrequencyHz), Is.All.InRange(1f, 1500f));
            Assert.That(XrHand.Right.Impulses, Is.Empty);
        }

        [Test]
        public void ParametricHapticsAreUsedOnlyWhenTheAuthorEnablesThem()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            Add<ControllerParametricOutput>();
            World.Frames(72);
            Assert.That(OVRInput.Parametric, Is.Empty);
            Assert.That(Log.Count("experimental", LogType.Warning), Is.EqualTo(1));
        }

        [Test]
        public void ParametricFramesObeyTheRulesOfStreams()
        {
            HeldDevices.TakeTouchController();
            Add<ControllerParametricOutput>(output => output.UseExperimentalFeature = true);
            World.Frames(144);
            Assert.That(OVRInput.Parametric.Count, Is.InRange(60, 110));
            Assert.That((int)OVRInput.Parametric[0].Sent.StreamFrameType, Is.EqualTo(1));
            Assert.That(OVRInput.Parametric[0].Sent.AmplitudePoints[^1].Time, Is.GreaterThanOrEqualTo(40000000L));
            long end = 0L;
            foreach ((_, OVRInput.HapticsParametricVibration sent) in OVRInput.Parametric)
            {
                bool first = (int)sent.StreamFrameType == 1;
                end = first ? -1L : end;
                Assert.That(sent.AmplitudePoints.Length, Is.GreaterThanOrEqualTo(first ? 2 : 1));
                foreach (OVRInput.HapticsParametricPoint point in sent.AmplitudePoints)
                {
                    Assert.That(point.Time, Is.GreaterThan(end));
                    Assert.That(point.Value, Is.InRange(0f, 1f));
                    end = point.Time;
                }
                Assert.That(sent.FrequencyPoints.All(point => point.Value >= 0f && point.Value <= 1f && point.Time <= end));
                Assert.That(sent.MinFrequencyHz, Is.EqualTo(60f));
                Assert.That(sent.MaxFrequencyHz, Is.EqualTo(400f));
            }
        }

        [Test]
        public void AStopReachesTheDeviceWithinAFrame(
            [Values("panic", "panic of all", "mute", "switched off", "pause", "stylus off")] string how)
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            ControllerWaveformOutput output = Add<ControllerWaveformOutput>();
            World.Frames(72);
            Assert.That(OVRInput.Waves[^1].Samples.Length, Is.GreaterThan(20), "it plays");
            Stop(output, how);
            World.Frames(1);
            Assert.That(OVRInput.Waves[^1].Append, Is.False);
            Assert.That(OVRInput.Waves[^1].Samples.Length, Is.InRange(1, 7), "a fade of 3 ms replaces what is queued");
            Assert.That(OVRInput.Waves[^1].Samples[^1], Is.Zero);
            int before = OVRInput.Waves.Count;
            World.Frames(72);
            Assert.That(OVRInput.Waves.Count, Is.EqualTo(before), "and nothing follows");
        }

        [Test]
        public void AFrameOf200MillisecondsIsAGap()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            ControllerWaveformOutput output = Add<ControllerWaveformOutput>();
            World.Frames(72);
            float[] last = OVRInput.Waves[^1].Samples;
            Assert.That(last.Length / 2000.0, Is.LessThan(0.03));
            Assert.That(last[^1], Is.Zero, "every stretch ends with a fade");
            World.Frame(0.2);
            World.Frames(10);
            Assert.That(output.Statistics.Gaps, Is.EqualTo(1));
            Assert.That(output.Statistics.LatencyMilliseconds, Is.LessThan(40.0));
        }

        [Test]
        public void ASleepingControllerAndItsReplacementAreDetected()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            AutoOutput output = Add<AutoOutput>();
            World.Frames(72);
            Assert.That(output.Statistics.RateHz, Is.EqualTo(2000.0));
            OVRPlugin.Connected = OVRPlugin.Controller.None;
            World.Frames(5);
            int before = OVRInput.Waves.Count;
            World.Frames(72);
            Assert.That(OVRInput.Waves.Count, Is.EqualTo(before));
            Assert.That(output.HasDevice, Is.False);
            XrHand.Right.Take("Another controller", true);
            World.Frames(72);
            Assert.That(XrHand.Right.Impulses, Is.Not.Empty);
            Assert.That(output.DeviceName, Is.EqualTo("Another controller"));
            OVRInput.SampleRateHz = 500f;
            PlayOnTouch();
            Assert.That(OVRInput.Waves[^1].RateHz, Is.EqualTo(500f));
            Assert.That(OVRInput.FailedCalls, Is.Zero);
        }

        /// <summary>Runs only when selected: <c>dotnet test Tests/Dotnet/HaptoFlow.ShimTests --filter
        /// TestCategory=DocumentationPicture</c> writes the two waves for <c>scripts/pack/pictures.py</c>.
        /// </summary>
        [Test, Explicit, Category("DocumentationPicture")]
        public void WavesForTheDocumentationAreWritten()
        {
            PlayOnBothForSixSeconds();
            float fullScaleMps2 = HaptoFlowSettings.Active.FullScaleMps2;
            float[] audio = AudioDevice.Samples();
            Directory.CreateDirectory(RepositoryFiles.In("out", "pictures"));
            foreach ((string name, float[] wave) in new[] { ("audio", audio), ("controller", Felt()) })
            {
                File.WriteAllLines(RepositoryFiles.In("out", "pictures", $"{name}.txt"), wave.Select(sample =>
                    (sample * fullScaleMps2).ToString("R", CultureInfo.InvariantCulture)));
            }
            Assert.That(audio.Length, Is.GreaterThan(250000));
        }

        [Test]
        public void AControllerPlaysTheLevelAndSpectrumOfAnAudioOutput()
        {
            PlayOnBothForSixSeconds();
            double[] controller = Bands(Felt(), 2000.0);
            double[] audio = Bands(AudioDevice.Samples(), 48000.0);
            for (int band = 0; band < audio.Length; ++band)
            {
                TestContext.WriteLine($"band {band}: audio {audio[band]:0.0} dB, controller {controller[band]:0.0} dB");
                Assert.That(controller[band], Is.EqualTo(audio[band]).Within(2.5));
            }
        }

        [Test]
        public void AnImpactWithoutADeviceIsNotPlayedLater()
        {
            var output = Add<MotorOutput>();
            XrHand.Right.Take("A controller", true);
            Func<double, Vector3> circle = Pen.GetComponent<PathMover>().Path!;
            Pen.GetComponent<PathMover>().Path = _ => new Vector3(0f, 0.3f, 0f);
            World.Frames(72);
            XrHand.Right.IsThere = false;
            World.Frames(72);
            Pen.GetComponent<PathMover>().Path = circle;
            World.Frames(36);
            Pen.GetComponent<PathMover>().Path = _ => new Vector3(0f, 0.3f, 0f);
            World.Frames(72);
            XrHand.Right.Impulses.Clear();
            XrHand.Right.Take("A controller", true);
            World.Frames(72);
            Assert.That(output.HasDevice, Is.True);
            Assert.That(XrHand.Right.Impulses, Is.Empty, "the pen is in the air");
        }

        [Test]
        public void AnOutputEnabledDuringATouchDoesNotRepeatTheImpact()
        {
            XrHand.Right.Take("A controller", true);
            var output = AddAtTrueLevel<MotorOutput>();
            LandInHalfASecond();
            World.Frames(144);
            Assert.That(XrHand.Right.Impulses, Is.Not.Empty, "the landing itself");
            output.enabled = false;
            World.Frames(36);
            XrHand.Right.Impulses.Clear();
            output.enabled = true;
            World.Frames(72);
            Assert.That(Pen.IsTouching, Is.True);
            Assert.That(XrHand.Right.Impulses, Is.Empty, "the touch-down was two seconds ago");
        }

        [Test]
        public void DeviceOutputsAllocateNothing([Values] bool waveform)
        {
            OVRInput.Records = false;
            OVRPlugin.Connected = waveform ? OVRPlugin.Controller.RTouch : OVRPlugin.Controller.None;
            XrHand.Right.Take("A controller", true);
            XrHand.Right.Impulses.Capacity = 1000;
            World.Frames(150);
            Assert.That(GarbageTests.BytesOf(180), Is.Zero);
            Assert.That(waveform ? OVRInput.Submissions : XrHand.Right.Impulses.Count, Is.GreaterThan(200));
        }

        private T AddAtTrueLevel<T>()
            where T : DeviceOutput
        {
            T output = Add<T>();
            output.TrueLevel = true;
            output.FullScaleMps2 = HaptoFlowSettings.Active.FullScaleMps2;
            return output;
        }

        /// <summary>On a controller, and on the audio device.</summary>
        private void PlayOnBothForSixSeconds()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            Output(out _);
            AddAtTrueLevel<ControllerWaveformOutput>();
            World.Frames(72);
            AudioDevice.Forget();
            OVRInput.Waves.Clear();
            World.Frames(6 * 72);
        }

        [Test]
        public void AMotorPlaysMoreByTheLoudnessLawThanInProportionAndByDeviceLoudness()
        {
            XrHand.Right.Take("A controller", true);
            var output = Add<MotorOutput>();
            double Average()
            {
                World.Frames(36);
                XrHand.Right.Impulses.Clear();
                World.Frames(144);
                return XrHand.Right.Impulses.Average(each => each.Amplitude);
            }
            double byLaw = Average();
            Assert.That(byLaw, Is.InRange(0.1, 0.9));
            output.DeviceLoudness = 0.5f;
            Assert.That(Average(), Is.EqualTo(0.5 * byLaw).Within(0.15 * byLaw));
            output.TrueLevel = true;
            Assert.That(Average(), Is.LessThan(0.5 * byLaw));
        }

        /// <summary>The samples that a controller with an exact clock plays: each submission until the next one
        /// replaces it.</summary>
        private static float[] Felt() => Enumerable.Range(0, OVRInput.Waves.Count - 1).SelectMany(index =>
        {
            Assert.That(OVRInput.Waves[index].Append, Is.False);
            double seconds = OVRInput.Waves[index + 1].Seconds - OVRInput.Waves[index].Seconds;
            return OVRInput.Waves[index].Samples.Take((int)Math.Round(2000.0 * seconds));
        }).ToArray();

        /// <summary>The levels in octave bands around 62, 125, 250 and 500 Hz, in dB.</summary>
        private static double[] Bands(float[] samples, double rateHz)
        {
            double[] energies = new double[4];
            int window = (int)(0.128 * rateHz);
            for (int begin = 0; begin + window <= samples.Length; begin += window)
            {
                for (int bin = 6; bin < 92; ++bin)
                {
                    double hertz = bin / 0.128;
                    double cosine = 0.0;
                    double sine = 0.0;
                    for (int index = 0; index < window; ++index)
                    {
                        double weighted = samples[begin + index] * (0.5 - 0.5 * Math.Cos(2.0 * Math.PI * index / window));
                        cosine += weighted * Math.Cos(2.0 * Math.PI * bin * index / window);
                        sine += weighted * Math.Sin(2.0 * Math.PI * bin * index / window);
                    }
                    int band = (int)Math.Floor(Math.Log(hertz / 44.0, 2.0));
                    if (band >= 0 && band < energies.Length)
                    {
                        energies[band] += (cosine * cosine + sine * sine) / ((double)window * window);
                    }
                }
            }
            int windows = samples.Length / window;
            return Array.ConvertAll(energies, energy => 10.0 * Math.Log10(energy / windows + 1e-12));
        }
    }

    /// <summary>A stylus in the right hand that circles on a wooden board, at 72 frames a second.</summary>
    public abstract class HeldDeviceTest : SceneTest
    {
        protected HapticStylus Pen { get; set; } = null!;

        [OneTimeSetUp]
        public void LoadOptionalAssemblies() => OptionalAssemblies.Load();

        [SetUp]
        public void CreateAStylusInTheRightHand()
        {
            ForgetDevices();
            SetFrameRate(72.0);
            FinishLoading();
            Board();
            Pen = Circling();
            Pen.Hand = HapticHand.Right;
        }

        [TearDown]
        public void ForgetDevices()
        {
            HeldDevices.Reset();
            SimulatedInput.Reset();
        }

        internal TOutput Add<TOutput>(Action<TOutput>? prepare = null)
            where TOutput : DeviceOutput
        {
            GameObject owner = Make(typeof(TOutput).Name);
            owner.SetActive(false);
            var output = owner.AddComponent<TOutput>();
            output.Stylus = Pen;
            prepare?.Invoke(output);
            owner.SetActive(true);
            return output;
        }

        /// <summary>Plays a second on a Touch controller in the right hand.</summary>
        internal static void PlayOnTouch()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            World.Frames(72);
        }

        /// <summary>The tip comes down fast after half a second, and then rests on the board, which plays only impacts.
        /// </summary>
        internal void LandInHalfASecond()
        {
            All<HapticSurface>().Single().Material.Effects = HapticEffects.Impact;
            double start = Clock.Seconds;
            Pen.GetComponent<PathMover>().Path = _ =>
                new Vector3(0f, Math.Max(0.001f, 0.3f - (float)Math.Max(0.0, Clock.Seconds - start - 0.5)), 0f);
        }

        internal void Stop(DeviceOutput output, string how)
        {
            switch (how)
            {
                case "panic":
                    output.Panic();
                    break;
                case "panic of all":
                    Haptics.Panic();
                    break;
                case "mute":
                    output.Muted = true;
                    break;
                case "switched off":
                    output.enabled = false;
                    break;
                case "pause":
                    Pause(output, true);
                    break;
                default:
                    Pen.enabled = false;
                    break;
            }
        }

        internal static void Pause(DeviceOutput output, bool paused) =>
            output.SendMessage("OnApplicationPause", paused);
    }
}
