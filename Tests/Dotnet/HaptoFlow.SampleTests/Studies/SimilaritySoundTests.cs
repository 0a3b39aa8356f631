using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Samples.SimilarityStudy;
using HaptoFlow.Studies;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests.Similarity
{
    /// <summary>The output of a trial: its model, its material, its delay.</summary>
    public sealed class SimilaritySoundTests : SimilarityTest
    {
        private const int OutputHz = 48000;
        private const int BlockFrames = 512;
        private static readonly string[] Two = { "wood", "metal mesh" };

        [Test]
        public void EveryTrialUsesOnlyThePlannedModelAndTier()
        {
            Begin(Settings(2, 4));
            int trials = 0;
            while (scene.Session!.Phase != StudyPhase.Finished)
            {
                scene.Session.Continue();
                if (scene.Session.Phase != StudyPhase.Task)
                {
                    continue;
                }
                PlannedTrial trial = scene.Session.Trial!;
                TraceReal();
                HapticEngine before = HapticSession.Current.Engine!;
                ulong segments = before.Statistics().Segments;
                TraceVirtual();
                HapticLoadedModel planned = scene.Models!.Of(trial.Method!);
                StudyMethod method = scene.Settings!.Methods.Single(each => each.Name == trial.Method);
                Assert.That(planned.IsInUse, Is.True, $"trial {trial.Trial}");
                Assert.That(planned.Model, Is.SameAs(method.Model));
                Assert.That(planned.TierName, Is.EqualTo(method.Quality == HapticQuality.Draft ? "draft" : "standard"));
                Assert.That(HapticSession.Current.Engine, Is.SameAs(before));
                Assert.That(before.Statistics().Segments, Is.GreaterThan(segments), $"trial {trial.Trial}");
                StudyMaterial material = scene.Settings.Materials.Single(each => each.Name == trial.Material);
                Assert.That(scene.Pen.Contact.Material!.Label, Is.EqualTo(material.Label));
                Assert.That(scene.Virtual.Surface.SharedDescription.Effects, Is.EqualTo(HapticEffects.Texture));
                Answer(4);
                ++trials;
            }
            Assert.That(trials, Is.EqualTo(4 + 8));
        }

        [Test]
        public void ATrialHasTheSameLevelAsTheMaterialInAnyOtherScene()
        {
            SimilarityStudySettings settings = Settings(
                Two.Select(label => new StudyMaterial("Sample of " + label, label)), Settings(1, 2).Methods);
            var expected = new Dictionary<string, double>();
            foreach (StudyMethod method in settings.Methods)
            {
                foreach (string label in Two)
                {
                    expected.Add(label + method.Name, LevelElsewhere(method.Model!, label));
                }
            }
            Assert.That(expected.Values.Min(), Is.GreaterThan(Audible));
            Assert.That(expected.Values.Max(), Is.GreaterThan(2.0 * expected.Values.Min()), "the cases must differ");
            World.FrameRateHz = 90.0;
            Begin(settings);
            while (scene.Session!.Phase != StudyPhase.Finished)
            {
                scene.Session.Continue();
                if (scene.Session.Phase != StudyPhase.Task)
                {
                    continue;
                }
                PlannedTrial trial = scene.Session.Trial!;
                TraceReal();
                TraceVirtual();
                double level = LevelOfCircle(scene.Virtual.Frame.position, scene.Output.Channel);
                string label = settings.Materials.Single(each => each.Name == trial.Material).Label;
                double expectedLevel = expected[label + trial.Method];
                Assert.That(level, Is.EqualTo(expectedLevel).Within(0.1 * expectedLevel), $"{label}, {trial.Method}");
                Answer(4);
            }
        }

        [Test]
        public void EveryMethodIsDelayedToTheSlowestOne()
        {
            inference = new Dictionary<string, double> { ["Ours quick"] = 3.0, ["Rival quick"] = 33.0 };
            // One audio block per frame, so that a touch comes at the same position of a block in every trial.
            World.FrameRateHz = OutputHz / (double)BlockFrames;
            Begin(Settings(1, 2));
            var onset = new Dictionary<string, double>();
            var artificial = new Dictionary<string, double>();
            double block = 1000.0 * BlockFrames / OutputHz;
            while (scene.Session!.Phase != StudyPhase.Finished)
            {
                scene.Session.Continue();
                if (scene.Session.Phase != StudyPhase.Task)
                {
                    continue;
                }
                string method = scene.Session.Trial!.Method!;
                TraceReal();
                TraceVirtual();
                onset[method] = OnsetMilliseconds();
                float set = scene.Output.Processing.DelayMilliseconds;
                Answer(4);
                Dictionary<string, string> row = Rows().Last();
                artificial[method] = Number(row, "artificial_delay_ms");
                double system = Number(row, "system_delay_ms");
                // The sum of frame, method, block, and the device delay of 20 ms in the settings.
                Assert.That(system, Is.EqualTo(block + inference[method] + block + 20.0).Within(0.1));
                Assert.That(Number(row, "delay_ms"), Is.EqualTo(Math.Ceiling(2.0 * block + 33.0 + 20.0 + 2.0)));
                Assert.That(set, Is.EqualTo(artificial[method]).Within(1e-3));
            }
            Assert.That(artificial["Ours quick"] - artificial["Rival quick"], Is.EqualTo(30.0).Within(0.01));
            Assert.That(onset["Ours quick"] - onset["Rival quick"], Is.EqualTo(30.0).Within(1.5));
            Assert.That(artificial["Rival quick"], Is.InRange(EqualDelay.ReserveMilliseconds,
                EqualDelay.ReserveMilliseconds + 1.0));
        }

        [Test]
        public void EveryMethodIsMeasuredLiveByDefault()
        {
            measure = null;
            Open(Settings(1, 2));
            Prepare();
            scene.Begin(7);
            foreach (StudyMethod method in scene.Settings!.Methods)
            {
                Assert.That(scene.Models!.InferenceMilliseconds(method.Name), Is.GreaterThan(0.0), method.Name);
            }
            double slowest = scene.Settings.Methods.Max(each => scene.Delay!.Of(each.Name).TotalMilliseconds);
            Assert.That(scene.Delay!.Milliseconds, Is.InRange(slowest + 2.0, slowest + 3.0));
        }

        [Test]
        public void TheNoisePlaysInTheHeadphonesAndNotOnTheActuator()
        {
            Open(Settings(1, 2));
            PlayFor(0.5);
            AudioDevice.Forget();
            PlayFor(0.5);
            Assert.That(Loudest(), Is.GreaterThan(Audible));
            Assert.That(LoudestFelt(), Is.Zero);
        }

        /// <summary>The root mean square of the actuator's channel while the pen draws circles.</summary>
        private double LevelOfCircle(Vector3 middle, int channel)
        {
            Vector3 At(int frame) => middle + 0.001f * Vector3.up + new Vector3(
                0.04f * (float)Math.Cos(0.05 * frame), 0f, 0.04f * (float)Math.Sin(0.05 * frame));
            for (int frame = 0; frame < 60; ++frame)
            {
                Hold(At(frame));
            }
            AudioDevice.Forget();
            for (int frame = 60; frame < 240; ++frame)
            {
                Hold(At(frame));
            }
            double level = Level(channel);
            Hold(At(240) + 0.05f * Vector3.up);
            return level;
        }

        /// <summary>Draws the same circles in a scene without a study.</summary>
        private double LevelElsewhere(HapticModelAsset model, string label)
        {
            Haptics.Restart();
            if (FindAll<AudioListener>().Length == 0)
            {
                Make("Listener").AddComponent<AudioListener>();
            }
            HaptoFlowSettings.Active.Model = model;
            FinishLoading();
            HapticSurface board = Board(label);
            board.Material.Effects = HapticEffects.Texture;
            Output(out HapticOutput output);
            HapticStylus stylus = StylusAlong(seconds =>
            {
                double angle = 0.05 * World.FrameRateHz * seconds;
                return new Vector3(0.04f * (float)Math.Cos(angle), 0.001f, 0.04f * (float)Math.Sin(angle));
            });
            World.Frames(60);
            AudioDevice.Forget();
            World.Frames(180);
            double level = Level(0);
            Crash();
            HaptoFlowSettings.Active.Model = DefaultModel.Asset();
            return level;
        }

        private static double Level(int channel) => Math.Sqrt(Enumerable.Range(0, AudioDevice.RecordedFrames)
            .Average(frame => AudioDevice.Sample(frame, channel) * (double)AudioDevice.Sample(frame, channel)));

        /// <summary>The time from the frame of a touch-down to the first vibration.</summary>
        private double OnsetMilliseconds()
        {
            Vector3 place = Corner(scene.Virtual.Frame, 0);
            Vector3 down = 0.001f * Vector3.up;
            Hold(place + 0.02f * Vector3.up);
            PlayFor(0.3);
            AudioDevice.Forget();
            for (int frame = 0; frame < 20; ++frame)
            {
                Hold(place + down + 0.004f * (frame + 1) * Vector3.right);
            }
            Hold(place + 0.05f * Vector3.up);
            int first = Enumerable.Range(0, AudioDevice.RecordedFrames)
                .First(frame => Math.Abs(AudioDevice.Sample(frame, scene.Output.Channel)) > 0f);
            return 1000.0 * first / OutputHz;
        }
    }
}
