using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.ShimTests
{
    /// <summary>A refusal lasts as long as its reason, and is said once.</summary>
    public sealed class RefusalTests : SceneTest
    {
        [Test]
        public void TheSixtyFifthStylusGetsItsVoiceWhenAnotherOneEnds()
        {
            FinishLoading();
            Board();
            Output(out _);
            List<HapticStylus> styluses = Enumerable.Range(0, 65).Select(_ => Circling()).ToList();
            World.Frames(60);
            HapticStylus refused = styluses.Single(each => !each.TryGetStatistics(out _));
            Assert.That(Log.Count("gets no voice"), Is.EqualTo(1), "once, not each time that it asks");
            Object.DestroyImmediate(styluses.First(each => each != refused).gameObject);
            World.Frames(60);
            Assert.That(refused.TryGetStatistics(out _), Is.True);
            Assert.That(Log.Count("has got its voice"), Is.EqualTo(1));
        }

        [Test]
        public void AFadingVoiceDoesNotKeepItsPlaceFromAnother()
        {
            FinishLoading();
            Board();
            Output(out _);
            List<HapticStylus> styluses = Enumerable.Range(0, 64).Select(_ => Circling()).ToList();
            World.Frames(30);
            styluses.ForEach(each => each.enabled = false);
            styluses.ForEach(each => each.enabled = true);
            World.Frames(1);
            Assert.That(styluses.Count(each => each.TryGetStatistics(out _)), Is.EqualTo(64));
            Assert.That(Log.Count("gets no voice"), Is.Zero);
        }

        [Test]
        public void AStylusThatIsEnabledAgainAsksAtOnce()
        {
            FinishLoading();
            Board();
            Output(out _);
            List<HapticStylus> styluses = Enumerable.Range(0, 65).Select(_ => Circling()).ToList();
            World.Frames(3);
            HapticStylus refused = styluses.Single(each => !each.TryGetStatistics(out _));
            styluses.First(each => each != refused).enabled = false;
            refused.enabled = false;
            refused.enabled = true;
            World.Frame();
            Assert.That(refused.TryGetStatistics(out _), Is.True);
        }

        [Test]
        public void ADeviceOfAnotherRateIsServedAtOnceAfterOneThatCouldNotBe()
        {
            FinishLoading();
            Board();
            AudioDevice.ChangeDevice(384000, 1024, AudioSpeakerMode.Stereo);
            HapticStylus stylus = Circling();
            World.Frames(60);
            Assert.That(stylus.TryGetStatistics(out _), Is.False);
            Assert.That(Log.Count("gets no voice"), Is.EqualTo(1));
            AudioDevice.ChangeDevice(48000, 512, AudioSpeakerMode.Stereo);
            World.Frames(2);
            Assert.That(stylus.TryGetStatistics(out _), Is.True);
        }

        [TestCase(false, "no model is chosen: choose one in Project Settings")]
        [TestCase(true, "checksum")]
        public void AModelThatWasMissingOrDamagedIsNamedOnceAndLoadedWhenAnotherIsThere(bool isDamaged, string why)
        {
            HaptoFlowSettings settings = HaptoFlowSettings.Active;
            HapticModelAsset? whole = settings.Model;
            settings.Model = isDamaged ? EditedModel.Damaged() : null;
            FinishLoading();
            Board();
            Output(out _);
            HapticStylus stylus = Circling();
            World.Frames(20);
            Assert.That((stylus.IsTouching, stylus.TryGetStatistics(out _), Haptics.IsReady), Is.EqualTo((true, false, false)));
            Assert.That(Haptics.Problem, Does.Contain(why));
            Assert.That(Log.Count("the scene runs without haptics"), Is.EqualTo(1));
            settings.Model = whole;
            World.Frame();
            FinishLoading();
            World.Frames(20);
            Assert.That(stylus.TryGetStatistics(out _), Is.True);
            Assert.That(Log.Count("the scene runs without haptics"), Is.EqualTo(1));
        }
    }
}
