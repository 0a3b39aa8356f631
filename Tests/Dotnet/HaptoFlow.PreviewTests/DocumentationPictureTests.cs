using System;
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
        public void TheWindowIsDrawnForTheDocumentation() =>
            Draw("texture-preview.png", StrokePreset.Spiral, new StrokeSettings(0.12, 1.5, 30.0, 2.4), 1.3,
                new[] { new LabelMix("corduroy"), new LabelMix("wood", "sandpaper", 0.3f) }, _ => { });

        /// <summary>The same, for what is felt through devices without the wave.</summary>
        [Test, Explicit, Category("DocumentationPicture")]
        [TestCase("output-controller.png", nameof(PreviewDevice.Controller))]
        [TestCase("output-motor.png", nameof(PreviewDevice.Motor))]
        public void WhatADeviceMakesOfTheWaveIsDrawnForTheDocumentation(string file, string device) =>
            Draw(file, StrokePreset.Taps, new StrokeSettings(0.12, 1.0, 0.0, 1.6, 0.3), 0.5,
                new[] { new LabelMix("concrete") }, request =>
                {
                    request.Device = Enum.Parse<PreviewDevice>(device);
                    request.Effects = HapticEffects.Texture | HapticEffects.Impact | HapticEffects.Edge;
                });

        private static void Draw(string file, StrokePreset preset, StrokeSettings settings, double playedSeconds,
            LabelMix[] materials, Action<PreviewRequest> change)
        {
            using var worker = new PreviewWorker();
            var layout = new PreviewLayout(1200.0, 900.0);
            var request = new PreviewRequest(File.ReadAllBytes(RepositoryFiles.DefaultModel),
                PresetStrokes.Make(preset, settings), materials)
            {
                StrokePanel = layout.StrokePanel,
                Charts = layout.Charts,
                PixelsPerPoint = 1.5,
                Measurement = 1,
            };
            change(request);
            PreviewResult result = worker.Do(request, CancellationToken.None);
            Assert.That(result.Problem, Is.Null);
            string path = RepositoryFiles.In("Documentation~", "images", file);
            Png.Write(path, WindowPicture.Draw(result, layout, settings, preset.ToString(), playedSeconds),
                request.ModelFile);
            Assert.That(new FileInfo(path).Length, Is.GreaterThan(50_000));
        }
    }
}
