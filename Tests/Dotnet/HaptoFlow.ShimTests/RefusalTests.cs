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
            Assert.That(Said("gets no voice"), Is.EqualTo(1), "once, not each time that it asks");
            Object.DestroyImmediate(styluses.First(each => each != refused).gameObject);
            World.Frames(60);
            Assert.That(refused.TryGetStatistics(out _), Is.True);
            Assert.That(Said("has got its voice"), Is.EqualTo(1));
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
            Assert.That(Said("gets no voice"), Is.Zero);
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
            Assert.That(Said("gets no voice"), Is.EqualTo(1));
            AudioDevice.ChangeDevice(48000, 512, AudioSpeakerMode.Stereo);
            World.Frames(2);
            Assert.That(stylus.TryGetStatistics(out _), Is.True);
        }

        [TestCase(false)]
        [TestCase(true)]
        public void AModelThatWasMissingOrDamagedIsLoadedWhenAnotherIsThere(bool isDamaged)
        {
            HaptoFlowSettings settings = HaptoFlowSettings.Active;
            HapticModelAsset? whole = settings.Model;
            settings.Model = isDamaged ? HapticModelAsset.Create(new byte[100]) : null;
            FinishLoading();
            Board();
            Output(out _);
            HapticStylus stylus = Circling();
            World.Frames(20);
            Assert.That(stylus.TryGetStatistics(out _), Is.False);
            Assert.That(Said("the scene runs without haptics"), Is.EqualTo(1));
            settings.Model = whole;
            World.Frame();
            FinishLoading();
            World.Frames(20);
            Assert.That(stylus.TryGetStatistics(out _), Is.True);
            Assert.That(Said("the scene runs without haptics"), Is.EqualTo(1));
        }

        [Test]
        public void TheSixtyFifthLearntMaterialIsFeltWhenAnotherIsUnloaded()
        {
            FinishLoading();
            string text = Model.MaterialText.OfLabel(DefaultModel.Asset().File, "corduroy");
            HapticMaterial[] materials = Enumerable.Range(0, 65)
                .Select(_ => HapticMaterial.Create(text, "fur")).ToArray();
            foreach (HapticMaterial material in materials)
            {
                Board().SharedMaterial = material;
            }
            HapticSession.Current.FinishRegistrations();
            Assert.That((Haptics.LearntMaterials, Haptics.RefusedMaterials), Is.EqualTo((64, 1)));
            Assert.That(Said("64 learnt materials are in use"), Is.EqualTo(1));
            Object.DestroyImmediate(materials[7]);
            HapticSession.Current.FinishRegistrations();
            Assert.That((Haptics.LearntMaterials, Haptics.RefusedMaterials), Is.EqualTo((64, 0)));
            Assert.That(Said("64 learnt materials are in use"), Is.EqualTo(1));
        }

        private static int Said(string part) =>
            Log.Lines.Count(line => line.Text.Contains(part, StringComparison.Ordinal));
    }
}
