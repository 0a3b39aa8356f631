using System.Linq;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.Audio;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    public sealed class MixerEffectTests : SceneTest
    {
        [Test]
        public void TheMixerEffectGetsTheVoiceAndRendersIt()
        {
            FinishLoading();
            Board();
            AudioTap tap = Output(out HapticOutput output);
            var mixer = new AudioMixer();
            mixer.Exposed["Pen"] = -1f;
            output.Route = OutputRoute.MixerEffect;
            output.SetMixer(mixer, "Pen");
            HapticStylus other = StylusAlong(_ => new Vector3(0f, 1f, 0f));
            World.Frames(3);
            // Voices of another scene that still fade have slots, too.
            float slotOfOther = mixer.Exposed["Pen"];
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.05f * (float)seconds, 0.001f, 0f));
            World.Frames(30);
            Assert.That(slotOfOther, Is.GreaterThanOrEqualTo(0f));
            Assert.That(mixer.Exposed["Pen"], Is.GreaterThanOrEqualTo(0f).And.Not.EqualTo(slotOfOther), "the slot of the second voice");
            Assert.That(tap.Peak(), Is.Zero);
            Assert.That(stylus.TryGetStatistics(out VoiceStatistics statistics), Is.True);
            Assert.That(statistics.RenderedFrames, Is.Zero);
            Assert.That(other.TryGetStatistics(out _), Is.True);
        }

        [Test]
        public void AMixerWithoutTheParameterIsLogged()
        {
            FinishLoading();
            Output(out HapticOutput output);
            output.Route = OutputRoute.MixerEffect;
            output.SetMixer(new AudioMixer(), "Pen");
            StylusAlong(_ => Vector3.up);
            World.Frames(3);
            int messageCount = Log.Count("\"Pen\"", LogType.Warning);
            Assert.That(messageCount, Is.EqualTo(1));
        }
    }
}
