using System.IO;
using System.Linq;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>Objects of one label, with a model that tells its recorded pieces apart.</summary>
    public sealed class VariationTests : SceneTest
    {
        [Test]
        public void AnObjectWithAVariationDiffersFromItsLabelAndIsTheSameInEverySession()
        {
            float[] mean = Stroke(0f, 7);
            float[] varied = Stroke(1f, 7);
            Assert.That(mean.Max(), Is.GreaterThan(0f));
            Assert.That(varied, Is.Not.EqualTo(mean));
            Assert.That(Stroke(1f, 7), Is.EqualTo(varied));
            Assert.That(Stroke(0f, 7), Is.EqualTo(mean));
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
        private float[] Stroke(float variation, uint seed)
        {
            EndScene();
            BeginScene();
            HaptoFlowSettings.Active.Model = HapticModelAsset.Create(
                File.ReadAllBytes(RepositoryFiles.In("Tests", "Golden", "model", "skeleton.haptoflow")));
            FinishLoading();
            HapticSurface board = Tagged<BoxCollider>("smooth", box =>
            {
                box.size = new Vector3(2f, 0.02f, 2f);
                box.center = new Vector3(0f, -0.01f, 0f);
            });
            board.Variation = variation;
            board.Seed = seed;
            Output(out _);
            StylusAlong(seconds => new Vector3(0.15f * (float)seconds - 0.5f, 0.001f, 0f));
            World.Frames((int)(0.5 * World.FrameRateHz));
            AudioDevice.Forget();
            World.Frames((int)(1.0 * World.FrameRateHz));
            return AudioDevice.Samples();
        }
    }
}
