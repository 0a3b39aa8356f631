using System;
using System.Linq;
using System.Reflection;
using System.Runtime.CompilerServices;
using System.Text;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.ShimTests
{
    /// <summary>Clips on styluses: what plays them, what ends them, and what they do not survive.</summary>
    public sealed class ClipTests : SceneTest
    {
        private const float Audible = 0.02f;

        private AudioTap tap = null!;
        private HapticStylus stylus = null!;
        private HapticSurface board = null!;

        [SetUp]
        public void HoldAStylusInTheAir()
        {
            board = Board();
            tap = Output(out _);
            stylus = StylusAlong(_ => new Vector3(0f, 0.3f, 0f));
        }

        [Test]
        public void AClipPlaysInTheAirAndEnds()
        {
            Begin();
            Assert.That(stylus.Play(Hum(0.4)), Is.True);
            Assert.That(PeakOf(20), Is.GreaterThan(Audible));
            World.Frames(40);
            Assert.That(PeakOf(20), Is.Zero);
            Assert.That(ClipsOf(stylus), Is.EqualTo(1UL));
        }

        [Test]
        public void ALoopGoesOnUntilItIsStopped()
        {
            Begin();
            stylus.Play(Hum(0.2), 1f, true);
            World.Frames(90);
            Assert.That(PeakOf(20), Is.GreaterThan(Audible));
            stylus.StopClip();
            World.Frames(5);
            Assert.That(PeakOf(20), Is.Zero);
            stylus.StopClip();
        }

        [Test]
        public void ADestroyedClipPlaysToItsEndAndIsNotPlayedAgain()
        {
            Begin();
            HapticClip clip = Hum(0.5);
            stylus.Play(clip);
            Object.DestroyImmediate(clip);
            Assert.That(PeakOf(20), Is.GreaterThan(Audible));
            Assert.That(stylus.Play(clip), Is.False);
            World.Frames(60);
            Assert.That(PeakOf(20), Is.Zero);
        }

        [Test]
        public void WhileTheEngineLoadsAClickIsDroppedAndNothingIsSaid()
        {
            HapticClip clip = Hum(0.5);
            int lines = Log.Lines.Count;
            Assert.That(stylus.Play(clip), Is.False);
            stylus.StopClip();
            Assert.That(stylus.Play(clip), Is.False);
            Assert.That(Log.Lines.Count, Is.EqualTo(lines));
            Begin();
            Assert.That(PeakOf(20), Is.Zero, "it is not played later");
        }

        [TestCase(float.NaN, 0.0)]
        [TestCase(-1f, 0.0)]
        [TestCase(0.5f, 0.05)]
        [TestCase(float.PositiveInfinity, 0.4)]
        public void AnyGainIsLimited(float gain, double peak)
        {
            Begin();
            Assert.That(stylus.Play(Hum(2.0), gain), Is.True);
            World.Frames(20);
            Assert.That(PeakOf(20), Is.EqualTo(peak).Within(0.25 * peak));
        }

        [Test]
        public void ADamagedClipIsSaidOnceAndEndsNothing()
        {
            Begin();
            HapticClip damaged = Keep(HapticClip.FromText("{\"version\":{\"major\":3},\"signals\":{}}"));
            damaged.name = "Knock";
            stylus.Play(Hum(3.0));
            Assert.That(damaged.Problem, Does.Contain("version.major"));
            Assert.That(damaged.Info.DurationSeconds, Is.Zero);
            Assert.That(stylus.Play(damaged), Is.False);
            Assert.That(stylus.Play(damaged), Is.False);
            Assert.That(stylus.Play(null), Is.False);
            Assert.That(Log.Count("the clip Knock is not felt: "), Is.EqualTo(1));
            Assert.That(PeakOf(20), Is.GreaterThan(Audible));
            Assert.That(Keep(HapticClip.Create(Array.Empty<byte>())).Problem, Is.Not.Null, "an empty file");
        }

        [Test]
        public void MuteAndPanicEndItForGood()
        {
            Begin();
            HapticClip clip = Hum(0.3);
            HapticOutput output = All<HapticOutput>().Single();
            stylus.Play(clip, 1f, true);
            World.Frames(10);
            output.Muted = true;
            World.Frames(5);
            Assert.That(stylus.Play(clip, 1f, true), Is.True);
            World.Frames(5);
            output.Muted = false;
            World.Frames(5);
            Assert.That(PeakOf(20), Is.Zero);
            stylus.Play(clip, 1f, true);
            World.Frames(10);
            stylus.Panic();
            World.Frames(5);
            Assert.That(PeakOf(20), Is.Zero);
        }

        [Test]
        public void ASurfacesStrengthIsThatOfATouchOnly()
        {
            board.Material.Strength = 0.05f;
            Object.DestroyImmediate(stylus.gameObject);
            float height = 0.001f;
            stylus = StylusAlong(_ => new Vector3(0.1f, height, 0f));
            Begin();
            World.Frames(5);
            Assert.That(stylus.IsTouching, Is.True);
            HapticClip clip = Hum(2.0);
            stylus.Play(clip);
            World.Frames(20);
            float touching = PeakOf(20);
            height = 0.3f;
            World.Frames(5);
            stylus.Play(clip);
            World.Frames(20);
            Assert.That(PeakOf(20), Is.EqualTo(0.1f).Within(0.03f));
            Assert.That(touching, Is.LessThan(0.02f));
        }

        [Test]
        public void PlayingAKnownClipMakesNoGarbage()
        {
            Begin();
            HapticClip clip = Hum(0.1);
            BytesOf(clip);
            Assert.That(BytesOf(clip), Is.Zero);
        }

        [Test]
        public void AnEmptyFieldOfAPlayerMeansTheStylusAboveItElseAllOfTheScene()
        {
            HapticStylus other = StylusAlong(_ => new Vector3(0.1f, 0.3f, 0f));
            Begin();
            var player = Make("Button").AddComponent<HapticClipPlayer>();
            player.Clip = Hum(0.1);
            player.Play();
            World.Frames(5);
            Assert.That((ClipsOf(stylus), ClipsOf(other)), Is.EqualTo((1UL, 1UL)));
            player.Stylus = other;
            player.Play();
            World.Frames(5);
            Assert.That((ClipsOf(stylus), ClipsOf(other)), Is.EqualTo((1UL, 2UL)));
            player.Stylus = null;
            player.transform.SetParent(stylus.transform, false);
            player.Play();
            World.Frames(5);
            Assert.That((ClipsOf(stylus), ClipsOf(other)), Is.EqualTo((2UL, 2UL)));
        }

        [Test]
        public void APlayerThatPlaysOnEnableWaitsForTheEngineAndEndsItsLoop()
        {
            GameObject owner = Make("Hum");
            owner.SetActive(false);
            var player = owner.AddComponent<HapticClipPlayer>();
            (player.Clip, player.Loop, player.PlayOnEnable) = (Hum(0.2), true, true);
            owner.SetActive(true);
            World.Frames(5);
            Begin();
            World.Frames(60);
            Assert.That(PeakOf(20), Is.GreaterThan(Audible));
            Assert.That(ClipsOf(stylus), Is.EqualTo(1UL));
            owner.SetActive(false);
            World.Frames(5);
            Assert.That(PeakOf(20), Is.Zero);
        }

        [Test]
        public void APlayerEndsItsOwnClipOnly()
        {
            Begin();
            var player = Make("Button").AddComponent<HapticClipPlayer>();
            player.Clip = Hum(0.3);
            player.Play();
            World.Frames(5);
            stylus.Play(Hum(0.3), 1f, true);
            World.Frames(5);
            player.Stop();
            World.Frames(40);
            Assert.That(PeakOf(20), Is.GreaterThan(Audible));
            player.Clip = null;
            player.Play();
            player.Stop();
            Assert.That(PeakOf(20), Is.GreaterThan(Audible));
        }

        [Test]
        public void ARestartEndsTheClipAndTheNextOneSounds()
        {
            Begin();
            HapticClip clip = Hum(0.3);
            stylus.Play(clip, 1f, true);
            World.Frames(10);
            Haptics.Restart();
            Assert.That(stylus.Play(clip), Is.False);
            FinishLoading();
            World.Frames(5);
            Assert.That(PeakOf(20), Is.Zero);
            Assert.That(stylus.Play(clip), Is.True);
            Assert.That(PeakOf(10), Is.GreaterThan(Audible));
        }

        [Test]
        public void AfterARecompilationTheSameAssetPlaysAgain()
        {
            Begin();
            HapticClip clip = Hum(0.5);
            stylus.Play(clip);
            // What a domain reload does: fields that are not serialised are lost, and OnEnable follows OnDisable.
            typeof(HapticClip).GetMethod("OnDisable", BindingFlags.Instance | BindingFlags.NonPublic)!.Invoke(clip, null);
            stylus.enabled = false;
            typeof(HapticStylus).GetField("voices", BindingFlags.Instance | BindingFlags.NonPublic)!.SetValue(stylus, null);
            HapticSession.ShutDown();
            stylus.enabled = true;
            FinishLoading();
            World.Frames(5);
            Assert.That(stylus.Play(clip), Is.True);
            Assert.That(PeakOf(20), Is.GreaterThan(Audible));
        }

        [Test]
        public void AnotherQualityLeavesTheClipAlone()
        {
            Begin();
            stylus.Play(Hum(0.3), 1f, true);
            Haptics.SetQuality(HapticQuality.Standard);
            World.Frames(10);
            Assert.That(PeakOf(20), Is.GreaterThan(Audible));
        }

        [Test]
        public void ALongClipAndAnEmptyOneAreHarmless()
        {
            Begin();
            HapticClip Continuous(string amplitude) => Keep(HapticClip.FromText(
                "{\"version\":{\"major\":1,\"minor\":0,\"patch\":0},\"signals\":{\"continuous\":{\"envelopes\":{" +
                "\"amplitude\":[" + amplitude + "]}}}}"));
            HapticClip hours = Continuous("{\"time\":0,\"amplitude\":0.5},{\"time\":599,\"amplitude\":0.5}");
            Assert.That(hours.Problem, Is.Null);
            Assert.That(stylus.Play(hours, 1f, true), Is.True);
            Assert.That(PeakOf(30), Is.GreaterThan(0.001f));
            stylus.StopClip();
            World.Frames(5);
            stylus.Play(Continuous(""), 1f, true);
            Assert.That(PeakOf(20), Is.Zero);
            Assert.That(tap.BrokenSamples, Is.Zero);
        }

        private static ulong ClipsOf(HapticStylus stylus) => StatisticsOf(stylus, HapticEffect.Clip).Events;

        [MethodImpl(MethodImplOptions.NoInlining)]
        private long BytesOf(HapticClip clip)
        {
            World.Frames(30);
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int index = 0; index < 30; ++index)
            {
                stylus.Play(clip, 0.5f);
                World.Frame();
            }
            return GC.GetAllocatedBytesForCurrentThread() - before;
        }

        private static void Begin()
        {
            FinishLoading();
            World.Frames(5);
        }

        private float PeakOf(int frames)
        {
            tap.Restart();
            World.Frames(frames);
            return tap.Peak();
        }

        /// <summary>A sine of 150 Hz; of 20 m/s^2, it is a tenth of full scale.</summary>
        private HapticClip Hum(double seconds, float amplitudeMps2 = 20f)
        {
            using HapticClipFile made = HapticClipFile.FromWave(
                Enumerable.Range(0, (int)(2000.0 * seconds))
                    .Select(sample => amplitudeMps2 * (float)Math.Sin(2.0 * Math.PI * 150.0 * sample / 2000.0)).ToArray(),
                2000);
            return Keep(HapticClip.Create(Encoding.UTF8.GetBytes(made.Write(HapticClipFormat.Hjif, DateTime.UtcNow))));
        }
    }

    public sealed class ClipDeviceTests : HeldDeviceTest
    {
        [Test]
        public void AClipSoundsOnAudioAndInTheHand()
        {
            Object.DestroyImmediate(Pen.gameObject);
            Pen = StylusAlong(_ => new Vector3(0f, 0.3f, 0f));
            Pen.Hand = HapticHand.Right;
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            AudioTap tap = Output(out HapticOutput output);
            Pen.Output = output;
            Pen.gameObject.AddComponent<AutoOutput>();
            World.Frames(36);
            using HapticClipFile hum = HapticClipFile.FromWave(
                Enumerable.Range(0, 2000).Select(sample => 20f * (float)Math.Sin(0.471 * sample)).ToArray(), 2000);
            HapticClip clip = Keep(HapticClip.FromText(hum.Write(HapticClipFormat.Haptic, DateTime.UtcNow)));
            tap.Restart();
            OVRInput.Waves.Clear();
            Assert.That(Pen.Play(clip), Is.True);
            World.Frames(36);
            Assert.That(tap.Peak(), Is.GreaterThan(0.02f));
            Assert.That(OVRInput.Waves.SelectMany(each => each.Samples).Max(), Is.GreaterThan(0.02f));
        }
    }
}
