using System;
using System.Diagnostics;
using System.IO;
using System.Threading;
using HaptoFlow.Preview;
using HaptoFlow.Recordings;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Draws the charts of the preview windows for the documentation, when they are asked for:
    /// <c>dotnet test Tests/Dotnet/HaptoFlow.EditorTests.csproj --filter TestCategory=DocumentationPicture</c>.</summary>
    [Explicit, Category("DocumentationPicture")]
    public sealed class DocumentationPictureTests
    {
        private const double PixelsPerPoint = 1.5;

        [TestCase("output-controller.png", nameof(PreviewDevice.Controller))]
        [TestCase("output-motor.png", nameof(PreviewDevice.Motor))]
        public void TheOutputOfADevice(string file, string device) =>
            DrawPreview(file, StrokePreset.Taps, new StrokeSettings(0.12, 1.0, 0.0, 1.6, 0.3), request =>
                {
                    request.Device = Enum.Parse<PreviewDevice>(device);
                    request.Effects = HapticEffects.Texture | HapticEffects.Impact | HapticEffects.Edge;
                }, new LabelMix("concrete"));

        [Test]
        public void TheSliders() =>
            DrawPreview("sliders.png", StrokePreset.Spiral, new StrokeSettings(0.12, 1.5, 30.0, 2.4), request =>
                {
                    request.Sliders = SliderSet.Read(File.ReadAllText(RepositoryFiles.In(
                        "Packages", "com.haptoflow.runtime", "Editor", "default.sliders.json")));
                    request.Active = 1;
                }, new LabelMix("wood"), new LabelMix("wood", "", 0f, "", new[] { 1f, -0.8f, 0f, 0f, 0.25f }));

        [Test]
        public void TheWindowThatLearnsMaterials()
        {
            byte[] model = File.ReadAllBytes(RepositoryFiles.DefaultModel);
            Recording recording = MadeRecordings.Doormat();
            using HapticLearning learning = HapticLearning.Start(model, recording,
                new LearningOptions { Name = recording.Label, Licence = recording.Licence });
            learning.Wait();
            Assert.That(learning.Problem, Is.Null);
            using var worker = new ComparisonWorker();
            ComparisonResult result = worker.Do(new ComparisonRequest(model, recording)
            {
                Material = learning.Material!,
                Active = 1,
            }, CancellationToken.None);
            Assert.That(result.Problem, Is.Null);
            LearningReport curves = LearningReport.Read(learning.Report!)!;
            Box charts = new PreviewLayout(1200.0, 700.0, PreviewRoom.WithoutStroke).Charts;
            Draw("new-material.png", charts, (canvas, box) => result.Panel.Draw(canvas, Palette.Dark, box, result.Active));
            Draw("new-material-curves.png", charts, (canvas, box) => LearningPanel.Draw(canvas, Palette.Dark, box, curves));
        }

        private static void DrawPreview(string file, StrokePreset preset, StrokeSettings settings,
            Action<PreviewRequest> change, params LabelMix[] materials)
        {
            using var worker = new PreviewWorker();
            var request = new PreviewRequest(
                File.ReadAllBytes(RepositoryFiles.DefaultModel), PresetStrokes.Make(preset, settings), materials);
            change(request);
            PreviewResult result = worker.Do(request, CancellationToken.None);
            Assert.That(result.Problem, Is.Null);
            // The table of times, which differ from machine to machine, is left out.
            Draw(file, new PreviewLayout(1200.0, 900.0).Charts,
                (canvas, box) => result.Panel.Draw(canvas, Palette.Dark, box, result.Request.Active));
        }

        /// <summary>Saves a picture with the hash of the model in it.</summary>
        private static void Draw(string file, Box charts, Action<ICanvas, Box> draw)
        {
            using var picture = new SkiaCanvas(charts.Width, charts.Height, PixelsPerPoint, Palette.Dark.Window);
            draw(picture, picture.Whole);
            LegibleTexts.Check(picture);
            string path = RepositoryFiles.In("Documentation~", "images", file);
            picture.Save(path);
            using Process stamp = Process.Start(new ProcessStartInfo("/usr/bin/python3")
            {
                ArgumentList = { RepositoryFiles.In("scripts", "pack", "renders.py"), path },
                UseShellExecute = false,
            })!;
            stamp.WaitForExit();
            Assert.That(stamp.ExitCode, Is.Zero);
            Assert.That(new FileInfo(path).Length, Is.GreaterThan(50_000));
        }
    }
}
