using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Linq;
using System.Threading;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.ShimTests
{
    /// <summary>Whatever ends a sound, it ends with the fade of 5 ms, and nobody waits for it.</summary>
    public sealed class EndOfSoundTests : SceneTest
    {
        private const int RateHz = 48000;
        private const int FadeFrames = RateHz * 5 / 1000;

        [TestCase(false)]
        [TestCase(true)]
        public void ADisabledOrDestroyedStylusIsHeardForItsFadeWithoutAStep(bool isDestroyed)
        {
            HapticStylus stylus = Sounding(out _, out float usual);
            ExpectAFade(isDestroyed ? () => Object.DestroyImmediate(stylus.gameObject) : () => stylus.enabled = false, usual);
            Assert.That(HapticSession.Current.Engine!.Statistics().Voices, Is.Zero);
        }

        [Test]
        public void AStylusDisabledInTheFirstFrameThatSoundsEndsWithoutAStep()
        {
            HapticStylus stylus = Sounding(out _, out float usual);
            stylus.enabled = false;
            World.Frames(10);
            stylus.enabled = true;
            int begun;
            do
            {
                begun = AudioDevice.RecordedFrames;
                World.Frame();
            }
            while (AudioDevice.RecordedFrames == begun || AudioDevice.Peak(0, begun) == 0f);
            ExpectAFade(() => stylus.enabled = false, usual);
        }

        [Test]
        public void ARestartedEngineEndsItsSoundWithAFade()
        {
            Sounding(out _, out float usual);
            // Without it, the new engine would sound before the old one's end is looked at.
            HaptoFlowSettings.Active.Model = null;
            ExpectAFade(Haptics.Restart, usual);
        }

        [Test]
        public void AnOutputTakenAwayUnderATouchFadesAndTheConsoleSaysSo()
        {
            HapticStylus stylus = Sounding(out HapticOutput first, out float usual);
            HapticOutput disabled = Make("Other").AddComponent<HapticOutput>();
            disabled.enabled = false;
            ExpectAFade(() => stylus.Output = disabled, usual);
            Assert.That(Log.Count("lost Output during a touch", LogType.Log), Is.EqualTo(1));
        }

        [TestCase(OutputRoute.AudioSource)]
        [TestCase(OutputRoute.ListenerChannel)]
        public void AnOutputSwitchedOffUnderATouchFadesAndSoundsAgainWhenItIsOn(OutputRoute route)
        {
            HapticStylus stylus = Sounding(out HapticOutput output, out float usual);
            if (route == OutputRoute.ListenerChannel)
            {
                Object.DestroyImmediate(output.gameObject);
                output = All<AudioListener>()[0].gameObject.AddComponent<HapticOutput>();
                output.Route = route;
                output.Channel = 0;
                stylus.Output = output;
                World.Frames(30);
            }
            ExpectAFade(() => output.enabled = false, usual);
            output.enabled = true;
            World.Frames(30);
            Assert.That(AudioDevice.Peak(0, AudioDevice.RecordedFrames - 4096), Is.GreaterThan(0.001f));
            // Off and on again within the fade.
            output.enabled = false;
            World.Frame();
            output.enabled = true;
            World.Frames(60);
            Assert.That(AudioDevice.Peak(0, AudioDevice.RecordedFrames - 4096), Is.InRange(0.001f, 0.9f));
        }

        [Test]
        public void AnOutputChangedUnderATouchFadesWhileTheNewOneGoesOn()
        {
            HapticStylus stylus = Sounding(out HapticOutput first, out float usual);
            first.Channel = 0;
            HapticOutput second = Make("Second").AddComponent<HapticOutput>();
            second.Channel = 1;
            World.Frames(3);
            stylus.Output = first;
            World.Frames(10);
            ExpectAFade(() => stylus.Output = second, usual);
            Assert.That(AudioDevice.Peak(1, AudioDevice.RecordedFrames - 4096), Is.GreaterThan(0.001f));
            Assert.That(Log.Count("goes on on Second", LogType.Log), Is.EqualTo(1));
            // Back and forth within one frame: nothing is left over, and nothing is said twice.
            stylus.Output = first;
            stylus.Output = second;
            World.Frames(3);
            Assert.That(HapticSession.Current.Engine!.Statistics().Voices, Is.EqualTo(1U));
            Assert.That(Log.Count("during a touch", LogType.Log), Is.EqualTo(1));
        }

        [Test]
        public void ASharedMaterialUnloadedUnderATouchEndsWithAFadeASentenceAndNoOtherMaterial()
        {
            HapticMaterial shared = Feeling("glass");
            HapticSurface? touched = null;
            Sounding(out _, out float usual, board => (touched = board).SharedMaterial = shared);
            ExpectAFade(() => Object.DestroyImmediate(shared), usual);
            Assert.That(Log.Count("no longer felt: its Haptic Material (label \"glass\")", LogType.Warning), Is.EqualTo(1));
            World.Frames(30);
            Assert.That(Log.Count("no longer felt", LogType.Warning), Is.EqualTo(1), "said once");
            HapticMaterial other = ScriptableObject.CreateInstance<HapticMaterial>();
            touched!.SharedMaterial = other;
            World.Frames(30);
            Assert.That(AudioDevice.Peak(0, AudioDevice.RecordedFrames - 4096), Is.GreaterThan(0.001f));
        }

        [Test]
        public void ALearntMaterialUnloadedUnderATouchEndsWithAFadeASentenceAndNoOtherMaterial()
        {
            HapticMaterial learnt = HapticMaterial.Create(
                Model.MaterialText.OfLabel(DefaultModel.Asset().File, "corduroy"), "fur");
            Sounding(out _, out float usual, board => board.Material.Learnt = learnt);
            ExpectAFade(() => Object.DestroyImmediate(learnt), usual);
            Assert.That(Log.Count("no longer felt", LogType.Warning), Is.EqualTo(1));
        }

        /// <summary>The audio thread of a device: it calls the filter at the pace of blocks, whatever the main thread
        /// does.</summary>
        [Test]
        [Retry(3)]
        public void WithAnAudioThreadOfItsOwnNoDisableStallsTheMainThreadForAMillisecondAndNoEndHasAStep()
        {
            const int rounds = 120;
            HapticSession.OptionsOverride = null;
            Object.DestroyImmediate(Stepper);
            FinishLoading();
            Board();
            Output(out HapticOutput output);
            output.GetComponent<AudioTap>().enabled = false;
            HapticStylus stylus = Circling();
            World.Frames(5);
            // The source is on a child of the output's object.
            output.GetComponentInChildren<AudioSource>(true).Stop();
            using var device = new FreeRunningDevice(output);
            var stalls = new List<double>();
            for (int round = 0; round < rounds; ++round)
            {
                for (int frame = 0; frame < 4 || !device.Sounds; ++frame)
                {
                    World.Frame();
                    Thread.Sleep(4);
                }
                long before = Stopwatch.GetTimestamp();
                stylus.enabled = false;
                stalls.Add(1000.0 * (Stopwatch.GetTimestamp() - before) / Stopwatch.Frequency);
                Thread.Sleep(round % 2 == 0 ? 1 : 25);
                stylus.enabled = true;
            }
            float[] heard = device.End();
            stalls.Sort();
            // A busy machine delays some; a wait for the audio thread would delay all.
            Assert.That(stalls[rounds / 2], Is.LessThan(1.0), "ms, the median");
            // A hard cut leaves zeros after any sample; the fade arrives at them.
            int ends = 0;
            float worst = 0f;
            for (int frame = 1; frame < heard.Length - FadeFrames; ++frame)
            {
                if (heard[frame] == 0f && heard[frame - 1] != 0f &&
                    heard.AsSpan(frame, 64).SequenceEqual(new float[64]))
                {
                    ++ends;
                    worst = Math.Max(worst, Math.Abs(heard[frame - 1]));
                }
            }
            Assert.That(ends, Is.GreaterThan(rounds / 4), "ends were heard");
            Assert.That(worst, Is.LessThan(0.02f * heard.Max()), "the last sample before silence");
        }

        private HapticStylus Sounding(out HapticOutput output, out float usual, Action<HapticSurface>? change = null)
        {
            FinishLoading();
            HapticSurface board = Board();
            change?.Invoke(board);
            HapticSession.Current.FinishRegistrations();
            Output(out output);
            HapticStylus stylus = Circling();
            World.Frames(45);
            Assert.That(AudioDevice.Peak(0, AudioDevice.RecordedFrames - 4096), Is.GreaterThan(0.001f));
            usual = Jump(1, AudioDevice.RecordedFrames);
            return stylus;
        }

        private static void ExpectAFade(Action end, float usual)
        {
            int from = AudioDevice.RecordedFrames;
            end();
            World.Frames(12);
            Assert.That(AudioDevice.Peak(0, from, from + FadeFrames / 2), Is.GreaterThan(0f), "the fade is heard");
            Assert.That(Jump(from, from + 4096), Is.LessThanOrEqualTo(1.5f * usual), "no step");
            // A block may pass before the change arrives.
            int after = from + FadeFrames + 2 * AudioDevice.Configuration.dspBufferSize + RateHz / 90;
            Assert.That(AudioDevice.Peak(0, after), Is.Zero, "silence after the fade");
        }

        private static float Jump(int from, int to) => Enumerable.Range(from, to - from)
            .Max(frame => Math.Abs(AudioDevice.Sample(frame, 0) - AudioDevice.Sample(frame - 1, 0)));

        private sealed class FreeRunningDevice : IDisposable
        {
            private const int BlockFrames = 256;
            private readonly List<float> heard = new List<float>();
            private readonly Thread thread;
            private volatile bool ends;
            private volatile bool sounds;

            public FreeRunningDevice(HapticOutput output)
            {
                thread = new Thread(() =>
                {
                    var block = new float[2 * BlockFrames];
                    Stopwatch clock = Stopwatch.StartNew();
                    for (long blocks = 1; !ends; ++blocks)
                    {
                        output.Render(block, 2);
                        for (int frame = 0; frame < BlockFrames; ++frame)
                        {
                            heard.Add(block[2 * frame]);
                        }
                        sounds = block.Any(sample => sample != 0f);
                        while (clock.Elapsed.TotalSeconds < blocks * BlockFrames / (double)RateHz)
                        {
                            Thread.Sleep(1);
                        }
                    }
                });
                thread.Start();
            }

            public bool Sounds => sounds;

            public float[] End()
            {
                ends = true;
                thread.Join();
                return heard.ToArray();
            }

            public void Dispose() => End();
        }
    }
}
