using System;
using System.Diagnostics;
using System.IO;
using System.Threading;
using HaptoFlow.Editor;
using HaptoFlow.Preview;
using HaptoFlow.Recordings;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    public sealed class DocumentationPictureTests
    {
        // The pictures show measured milliseconds: run these tests on an idle machine with
        //   dotnet test Tests/Dotnet/HaptoFlow.PreviewTests --filter TestCategory=DocumentationPicture
        [Test, Explicit, Category("DocumentationPicture")]
        [TestCase("output-controller.png", nameof(PreviewDevice.Controller))]
        [TestCase("output-motor.png", nameof(PreviewDevice.Motor))]
        public void TheOutputOfADeviceIsDrawnForTheDocumentation(string file, string device) =>
            Draw(file, StrokePreset.Taps, new StrokeSettings(0.12, 1.0, 0.0, 1.6, 0.3), 0.5,
                new[] { new LabelMix("concrete") }, request =>
                {
                    request.Device = Enum.Parse<PreviewDevice>(device);
                    request.Effects = HapticEffects.Texture | HapticEffects.Impact | HapticEffects.Edge;
                });

        /// <summary>Without milliseconds, which this picture is not about.</summary>
        [Test, Explicit, Category("DocumentationPicture")]
        public void TheSlidersAreDrawnForTheDocumentation()
        {
            SliderSet sliders = SliderSet.Read(File.ReadAllText(RepositoryFiles.In(
                "Packages", "com.haptoflow.runtime", "Editor", "Sliders", "default.sliders.json")));
            var moves = new[] { 1f, -0.8f, 0f, 0f, 0.25f };
            Draw("sliders.png", StrokePreset.Spiral, new StrokeSettings(0.12, 1.5, 30.0, 2.4), 1.3,
                new[] { new LabelMix("wood"), new LabelMix("wood", "", 0f, "", moves) }, request =>
                {
                    request.Sliders = sliders;
                    request.Active = 1;
                    request.Measurement = 0;
                }, PreviewRoom.WithSliders);
        }

        [Test, Explicit, Category("DocumentationPicture")]
        public void TheWindowThatLearnsMaterialsIsDrawnForTheDocumentation()
        {
            byte[] model = File.ReadAllBytes(RepositoryFiles.DefaultModel);
            Recording recording = MadeRecordings.Doormat();
            using HapticLearning learning = HapticLearning.Start(model, recording,
                new LearningOptions { Name = recording.Label, Licence = recording.Licence });
            learning.Wait();
            Assert.That(learning.Problem, Is.Null);
            using var worker = new ComparisonWorker();
            var layout = new PreviewLayout(1200.0, 700.0, PreviewRoom.WithoutStroke);
            ComparisonResult result = worker.Do(new ComparisonRequest(model, recording)
            {
                Material = learning.Material!,
                Active = 1,
            }, CancellationToken.None);
            Assert.That(result.Problem, Is.Null);
            LearningReport report = LearningReport.Read(learning.Report!)!;
            foreach ((string file, bool showsCurves) in new[]
                     {
                         ("new-material.png", false), ("new-material-curves.png", true),
                     })
            {
                using SkiaCanvas picture = WindowPicture.Draw(showsCurves, layout, recording.Label, recording.Licence,
                    NewMaterialControls.Describe(recording), report.Sentences,
                    (canvas, palette, box) =>
                    {
                        if (showsCurves)
                        {
                            LearningPanel.Draw(canvas, palette, box, report.Curves!);
                        }
                        else
                        {
                            result.Panel.Draw(canvas, palette, box, result.Active);
                        }
                    });
                LegibleTexts.Check(picture);
                Save(picture, RepositoryFiles.In("Documentation~", "images", file));
            }
        }

        /// <summary>Saves a picture with the hash of the model in it.</summary>
        private static void Save(SkiaCanvas picture, string path)
        {
            picture.Save(path);
            var command = new ProcessStartInfo("/usr/bin/python3")
            {
                ArgumentList = { RepositoryFiles.In("scripts", "pack", "renders.py"), path },
                UseShellExecute = false,
            };
            using Process stamp = Process.Start(command)!;
            stamp.WaitForExit();
            Assert.That(stamp.ExitCode, Is.Zero);
            Assert.That(new FileInfo(path).Length, Is.GreaterThan(50_000));
        }

        private static void Draw(string file, StrokePreset preset, StrokeSettings settings, double playedSeconds,
            LabelMix[] materials, Action<PreviewRequest> change, PreviewRoom room = PreviewRoom.Default)
        {
            using var worker = new PreviewWorker();
            var layout = new PreviewLayout(1200.0, 900.0, room);
            var request = new PreviewRequest(File.ReadAllBytes(RepositoryFiles.DefaultModel),
                PresetStrokes.Make(preset, settings), materials)
            {
                Measurement = 1,
            };
            change(request);
            PreviewResult result = worker.Do(request, CancellationToken.None);
            Assert.That(result.Problem, Is.Null);
            string path = RepositoryFiles.In("Documentation~", "images", file);
            using SkiaCanvas picture =
                WindowPicture.Draw(result, layout, settings, preset.ToString(), playedSeconds);
            Save(picture, path);
        }
    }
}
