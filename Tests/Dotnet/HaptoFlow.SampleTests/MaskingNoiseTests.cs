using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Studies;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>The masking noise plays in the headphones only.</summary>
    public sealed class MaskingNoiseTests : SampleTest
    {
        private const int HapticChannel = 1;

        private HapticOutput output = null!;
        private MaskingNoise noise = null!;

        [SetUp]
        public void PlayNoise()
        {
            GameObject ears = All<AudioListener>()[0].gameObject;
            output = ears.AddComponent<HapticOutput>();
            output.Route = OutputRoute.ListenerChannel;
            output.Channel = HapticChannel;
            noise = ears.AddComponent<MaskingNoise>();
            noise.Output = output;
        }

        [Test]
        public void TheNoiseDoesNotChangeTheHapticChannel(
            [Values(AudioSpeakerMode.Stereo, AudioSpeakerMode.Quad)] AudioSpeakerMode mode)
        {
            float[][] felt = { Stroke(mode, false), Stroke(mode, true) };
            Assert.That(felt[0].Max(), Is.GreaterThan(0.001f), "something is felt");
            // The strokes begin at different times, so they are compared by level.
            Assert.That(felt[1], Is.EqualTo(felt[0]).Within(1e-7f));
        }

        [Test]
        public void EveryOtherChannelPlaysTheNoiseAtItsLevel(
            [Values(NoiseColour.White, NoiseColour.Pink)] NoiseColour colour,
            [Values(-40f, MaskingNoise.MaximumDecibels)] float decibels)
        {
            AudioDevice.ChangeDevice(48000, 256, AudioSpeakerMode.Quad);
            noise.LevelDecibels = decibels;
            PlayTenSeconds(colour);
            foreach (int channel in new[] { 0, 2, 3 })
            {
                float[] samples = Channel(channel);
                double level = 10.0 * Math.Log10(samples.Average(sample => (double)sample * sample));
                Assert.That(level, Is.EqualTo(decibels).Within(0.5), $"channel {channel}");
                Assert.That(samples.Max(Math.Abs), Is.LessThan(1f), "nothing is clipped");
            }
            Assert.That(Channel(HapticChannel), Has.All.Zero);
        }

        [TestCase(NoiseColour.White, 0.0)]
        [TestCase(NoiseColour.Pink, -3.0)]
        public void PinkNoiseFallsByThreeDecibelsPerOctaveAndWhiteNoiseIsFlat(NoiseColour colour, double perOctave)
        {
            PlayTenSeconds(colour);
            float[] samples = Channel(0);
            double fall = (Density(samples, 3200.0) - Density(samples, 200.0)) / 4.0;
            Assert.That(fall, Is.EqualTo(perOctave).Within(0.5));
        }

        [Test]
        public void TheNoiseFadesInAndOutAndAllocatesNothing()
        {
            noise.LevelDecibels = MaskingNoise.MaximumDecibels;
            AudioDevice.Forget();
            World.Frames(40);
            float[] samples = Channel(0);
            Assert.That(samples.Take(48).Max(Math.Abs), Is.LessThan(0.04f));
            Assert.That(samples.Skip(4000).Max(Math.Abs), Is.GreaterThan(0.2f));
            Assert.That(AudioDevice.AllocatedBytes, Is.Zero);
            noise.enabled = false;
            World.Frames(1);
            AudioDevice.Forget();
            World.Frames(30);
            Assert.That(Channel(0), Has.All.Zero);
        }

        [Test]
        public void AnOutputOnAllOrNoChannelsStopsTheNoiseAndLogsAnError()
        {
            output.Route = OutputRoute.AudioSource;
            output.Channel = HapticVoice.AllChannels;
            LogAssert.Expect(LogType.Error, new System.Text.RegularExpressions.Regex("plays on all channels"));
            LogAssert.Expect(LogType.Error, new System.Text.RegularExpressions.Regex("choose the output"));
            World.Frames(60);
            Assert.That(noise.Problem, Does.Contain("all channels"));
            noise.Output = null;
            AudioDevice.Forget();
            World.Frames(60);
            Assert.That(noise.Problem, Does.Contain("choose the output"));
            Assert.That(Channel(0), Has.All.Zero);
            Assert.That(Channel(1), Has.All.Zero);
        }

        [Test]
        public void ADeviceWithTooFewChannelsStopsTheNoiseAndLogsAnError()
        {
            AudioDevice.ChangeDevice(48000, 512, AudioSpeakerMode.Mono);
            LogAssert.Expect(LogType.Error, new System.Text.RegularExpressions.Regex("has 1 channels"));
            World.Frames(30);
            Assert.That(noise.Problem, Does.Contain("plays on channel 1"));
            AudioDevice.ChangeDevice(48000, 512, AudioSpeakerMode.Stereo);
            World.Frames(30);
            Assert.That(noise.Problem, Is.Null);
        }

        private float[] Stroke(AudioSpeakerMode mode, bool withNoise)
        {
            AudioDevice.ChangeDevice(48000, 512, mode);
            noise.enabled = withNoise;
            noise.LevelDecibels = MaskingNoise.MaximumDecibels;
            HapticSession.ShutDown();
            HapticSurface board = Board();
            HapticStylus stylus = Circling();
            stylus.Output = output;
            FinishLoading();
            AudioDevice.Forget();
            World.Frames(90);
            float[] felt = Channel(HapticChannel);
            UnityEngine.Object.DestroyImmediate(stylus.gameObject);
            UnityEngine.Object.DestroyImmediate(board.gameObject);
            // The end of this stroke's sound is not part of the next.
            World.Frames(3);
            return felt;
        }

        private void PlayTenSeconds(NoiseColour colour)
        {
            noise.Colour = colour;
            World.Frames(30);
            AudioDevice.Forget();
            World.Frames(900);
        }


        /// <summary>The power in a third-octave band about a frequency, in dB, as a sum over single frequencies.
        /// </summary>
        private static double Density(IReadOnlyList<float> samples, double hertz)
        {
            const int length = 4096;
            double power = 0.0;
            int terms = 0;
            for (int start = 0; start + length <= samples.Count; start += length)
            {
                for (double tone = 0.85 * hertz; tone < 1.15 * hertz; tone += 0.03 * hertz)
                {
                    double real = 0.0;
                    double imaginary = 0.0;
                    for (int index = 0; index < length; ++index)
                    {
                        double angle = 2.0 * Math.PI * tone * index / 48000.0;
                        double window = 0.5 - 0.5 * Math.Cos(2.0 * Math.PI * index / length);
                        real += window * samples[start + index] * Math.Cos(angle);
                        imaginary += window * samples[start + index] * Math.Sin(angle);
                    }
                    power += real * real + imaginary * imaginary;
                    ++terms;
                }
            }
            return 10.0 * Math.Log10(power / terms);
        }
    }
}
