using System;
using System.IO;
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Preview;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityShim;

namespace HaptoFlow.PreviewTests
{
    /// <summary>The Texture Preview with a model file of published weights.</summary>
    public sealed class ImportedModelPreviewTests : PreviewWindowTest
    {
        [Test]
        public void TheTiersOfItsQualitiesPlayAndSoundDifferent()
        {
            HapticModelAsset model = HapticModelAsset.Create(
                File.ReadAllBytes(RepositoryFiles.In("Tests", "Golden", "model", "published.haptoflow")));
            State.Model = model;
            State.First.Label = "wool felt";
            float[]? before = null;
            string[] tiers = PreviewModel.Of(model).Tiers.ToArray();
            Assert.That(tiers, Is.EqualTo(new[] { "published-1-unguided", "published" }));
            foreach (string tier in tiers)
            {
                State.Change("Quality", state => state.Tier = tier);
                Window.Finish();
                Assert.That(Window.Session!.Problem, Is.Null);
                Assert.That(Window.Player!.PlayedSound!.Sound.Material, Is.EqualTo(new LabelMix("wool felt")));
                Assert.That(Samples.Max(Math.Abs), Is.GreaterThan(1e-4f), tier);
                Assert.That(Samples.SequenceEqual(before ?? Array.Empty<float>()), Is.False, tier);
                before = Samples;
            }
            EditorScreen.Enter("Sliders", true);
            WindowHost.Draw(Window);
            string[] shown = WindowHost.Draw(Window).Select(item => item.Label).ToArray();
            Assert.That(shown, Has.Member("Feature Scale").And.Some.StartsWith("This model has no sliders"));
        }
    }
}
