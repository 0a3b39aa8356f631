using System;
using System.IO;
using System.Linq;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>What a surface says of its sound reaches the voice; how that sounds is tested where it is made. The model
    /// tells its recorded pieces apart.</summary>
    public sealed class MaterialSoundTests : SceneTest
    {
        [Test]
        public void AFeatureScaleAToneAndAVariationChangeTheSoundAndItIsTheSameInEverySession(
            [Values("feature scale", "tone", "variation")] string what)
        {
            void Change(HapticSurface board)
            {
                board.Material.FeatureScale = what == "feature scale" ? 2f : 1f;
                board.Material.ToneDbPerOctave = what == "tone" ? 6f : 0f;
                board.Variation = what == "variation" ? 1f : 0f;
            }
            float[] plain = Stroke(_ => { }, out ulong runs);
            Assert.That((plain.Max() > 0f, runs), Is.EqualTo((true, 0UL)), "no tone is set");
            float[] changed = Stroke(Change, out runs);
            Assert.That(changed, Is.Not.EqualTo(plain));
            Assert.That(runs > 0UL, Is.EqualTo(what == "tone"));
            Assert.That(Stroke(Change, out _), Is.EqualTo(changed));
            Assert.That(Stroke(_ => { }, out _), Is.EqualTo(plain));
        }

        [Test]
        public void TheVariationIsLimitedToZeroToOne()
        {
            HapticSurface board = Board();
            board.Variation = 7f;
            Assert.That(board.Variation, Is.EqualTo(1f));
            board.Variation = -1f;
            Assert.That(board.Variation, Is.Zero);
        }

        /// <summary>The output of a stroke in a scene of its own.</summary>
        private float[] Stroke(Action<HapticSurface> change, out ulong toneRuns)
        {
            EndScene();
            BeginScene();
            HaptoFlowSettings.Active.Model = HapticModelAsset.Create(
                File.ReadAllBytes(RepositoryFiles.In("Tests", "Golden", "model", "skeleton.haptoflow")));
            FinishLoading();
            HapticSurface board = Board("smooth", 2f);
            board.Seed = 7;
            change(board);
            Output(out _);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.15f * (float)seconds - 0.5f, 0.001f, 0f));
            World.Frames((int)(0.5 * World.FrameRateHz));
            AudioDevice.Forget();
            World.Frames((int)(1.0 * World.FrameRateHz));
            toneRuns = StatisticsOf(stylus, HapticEffect.Tone).Runs;
            return AudioDevice.Samples();
        }
    }
}
