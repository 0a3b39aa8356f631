using System.IO;
using System.Threading;
using HaptoFlow.Preview;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    public sealed class DocumentationPictureTests
    {
        /// <summary>Only by name, on a machine that does nothing else, since the picture shows measured milliseconds:
        /// <c>dotnet test Tests/Dotnet/HaptoFlow.PreviewTests --filter TestCategory=DocumentationPicture</c>.</summary>
        [Test, Explicit, Category("DocumentationPicture")]
        public void TheWindowIsDrawnForTheDocumentation()
        {
            using var worker = new PreviewWorker();
            var layout = new PreviewLayout(1200.0, 834.0);
            var settings = new StrokeSettings(0.12, 1.5, 30.0, 2.4);
            var request = new PreviewRequest(File.ReadAllBytes(RepositoryFiles.DefaultModel),
                PresetStrokes.Make(StrokePreset.Spiral, settings),
                new[] { new LabelMix("corduroy"), new LabelMix("wood", "sandpaper", 0.3f) })
            {
                StrokePanel = layout.StrokePanel,
                Charts = layout.Charts,
                PixelsPerPoint = 1.5,
                Measurement = 1,
            };
            PreviewResult result = worker.Do(request, CancellationToken.None);
            Assert.That(result.Problem, Is.Null);
            string path = RepositoryFiles.In("Documentation~", "images", "texture-preview.png");
            Png.Write(path, WindowPicture.Draw(result, layout, settings, "Spiral", 1.3), request.ModelFile);
            Assert.That(new FileInfo(path).Length, Is.GreaterThan(50_000));
        }
    }
}
