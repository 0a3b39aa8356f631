using System;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;
using System.Threading;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Sliders change an embedding within the range of the labels' embeddings.</summary>
    public sealed class SliderSetTests
    {
        private static readonly string Text = File.ReadAllText(RepositoryFiles.In(
            "Packages", "com.haptoflow.runtime", "Editor", "default.sliders.json"));
        private static readonly JsonValue Json = JsonValue.Parse(Text);
        private static readonly SliderSet Sliders = SliderSet.Read(Text);

        private static MaterialFile Label(string name) =>
            MaterialFile.Read(MaterialText.OfLabel(ModelFiles.Default, name));

        [Test]
        public void ASliderChangesTheEmbeddingAlongItsDirection()
        {
            // In the middle of the labels no range limits it.
            double[] middle = Json["mean"].AsArray().Select(each => each.AsNumber()).ToArray();
            Assert.That(Sliders.Moved(middle, new[] { 0.25f }), Is.EqualTo(middle.Zip(Sliders.Sliders[0].Direction,
                (number, direction) => number + 0.25 * direction)).Within(1e-9));
        }

        [Test]
        public void SlidersKeepMaterialsInTheRangeOfTheLabels([Values(-1f, 1f, 1000f, -1000f)] float value)
        {
            foreach (HapticLabel label in ModelHeader.Read(ModelFiles.Default).Labels)
            {
                MaterialFile material = Label(label.Name);
                double[] moved = Sliders.Moved(material.Embedding, new[] { value, -value, value });
                for (int axis = 0; axis < 4; ++axis)
                {
                    double place = Sliders.Coordinate(moved, axis);
                    Assert.That(place, Is.InRange(Json["lowest"][axis].AsNumber() - 1e-5, Json["highest"][axis].AsNumber() + 1e-5));
                }
                Assert.That(moved.Skip(MaterialFile.TextureNumbers),
                    Is.EqualTo(material.Embedding.Skip(MaterialFile.TextureNumbers)), "wave vectors do not change");
            }
        }

        [Test]
        public void AMaterialOutsideTheRangeOfTheLabelsStaysWhereItIs()
        {
            double[] axis = Json["axes"][0].AsArray().Select(each => each.AsNumber()).ToArray();
            double[] far = Label("wood").Embedding.Select((number, index) => index < axis.Length ? number + 20.0 * axis[index] : number).ToArray();
            double place = Sliders.Coordinate(far, 0);
            Assert.That(place, Is.GreaterThan(Json["highest"][0].AsNumber()));
            Assert.That(Sliders.Coordinate(Sliders.Moved(far, new float[3]), 0), Is.EqualTo(place).Within(1e-9));
            foreach (float value in new[] { -1f, 1f })
            {
                Assert.That(Sliders.Coordinate(Sliders.Moved(far, new[] { value, value }), 0), Is.LessThanOrEqualTo(place + 1e-3));
            }
        }

        [Test]
        public void TheLevelSliderStaysInTheRangeOfAMaterialFile()
        {
            MaterialFile louder = MaterialFile.Read(Sliders.Moved(Label("wood"), new[] { 0f, 0f, 0f, 0f, 0.5f }, "louder"));
            Assert.That((louder.Name, louder.LevelOffsetDecibels), Is.EqualTo(("louder", 6.0)));
            MaterialFile much = louder;
            foreach (int _ in Enumerable.Range(0, 20))
            {
                much = MaterialFile.Read(Sliders.Moved(much, new[] { 0f, 0f, 0f, 0f, 1f }, "much"));
            }
            Assert.That(much.LevelOffsetDecibels, Is.EqualTo(24.0));
        }

        [TestCase("\"version\": 1", "\"version\": 2", "version is not 1: update HaptoFlow")]
        [TestCase("haptoflow-sliders", "haptoflow-material", "format is not \"haptoflow-sliders\"")]
        [TestCase("\"direction\": [", "\"direction\": [0,", "sliders[0].direction is not a list of")]
        [TestCase("\"lowest\": [", "\"lowest\": [0,", "lowest is not a list of")]
        [TestCase("\"mean\"", "\"means\"", "has no key \"mean\"")]
        public void AnInvalidFileIsRefusedWithTheNameOfItsKey(string part, string instead, string message)
        {
            Assert.That(Text, Does.Contain(part));
            Assert.That(Assert.Throws<HaptoFlowException>(() => SliderSet.Read(Text.Replace(part, instead)))!.Message,
                Does.Contain(message));
        }

        [Test]
        public void ANumberOutOfItsRangeIsRefusedWithItsPlace()
        {
            string first = Regex.Match(Text, "\"direction\": \\[([^,]+),").Groups[1].Value;
            AnInvalidFileIsRefusedWithTheNameOfItsKey(first, "1e7",
                "sliders[0].direction[0] is not a number from -1000000 to 1000000");
        }

        [Test]
        public void TheLevelSliderRaisesTheRmsByItsDecibels()
        {
            using var worker = new PreviewWorker();
            PreviewResult Render(float[] moves) => worker.Do(new PreviewRequest(ModelFiles.Default,
                PresetStrokes.Make(StrokePreset.Slide, new StrokeSettings(0.1, 1.0, 0.0, 1.0)),
                new[] { new LabelMix("wood"), new LabelMix("wood", "", 0f, "", moves) })
            {
                Sliders = Sliders,
                Tier = "draft",
            }, CancellationToken.None);
            PreviewResult louder = Render(new[] { 0f, 0f, 0f, 0f, 0.5f });
            Assert.That(louder.Problem, Is.Null);
            double decibels = 20.0 * Math.Log10(louder.Sounds[1].Sound.RmsMps2 / louder.Sounds[0].Sound.RmsMps2);
            Assert.That(decibels, Is.EqualTo(6.0).Within(1.5));
            Assert.That(louder.Sounds[1].Sound.Title, Is.EqualTo("wood, moved"));
            PreviewResult coarser = Render(new[] { 1f });
            Assert.That(coarser.Sounds[1].Sound.Samples, Is.Not.EqualTo(coarser.Sounds[0].Sound.Samples));
        }

        [Test]
        public void MorePositionsThanAnEngineKeepsReplaceTheOldest()
        {
            using var worker = new PreviewWorker();
            Stroke stroke = PresetStrokes.Make(StrokePreset.Slide, new StrokeSettings(0.1, 1.0, 0.0, 0.1));
            foreach (int step in Enumerable.Range(0, 9))
            {
                PreviewResult result = worker.Do(new PreviewRequest(ModelFiles.Default, stroke,
                    new[] { new LabelMix("wood", "", 0f, "", new[] { 0.01f * (step + 1) }) })
                {
                    Sliders = Sliders,
                    Tier = "draft",
                    IsSketch = true,
                }, CancellationToken.None);
                Assert.That(result.Problem, Is.Null);
            }
        }
    }
}
