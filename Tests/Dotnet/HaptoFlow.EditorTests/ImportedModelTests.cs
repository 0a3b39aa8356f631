using System;
using System.IO;
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.EditorTests
{
    /// <summary>A model file of published weights in a project: from the Project window to the loudspeakers.</summary>
    public sealed class ImportedModelTests : PlayedTest
    {
        private const int StrokeFrames = 90;

        [Test]
        public void ItIsImportedWithItsLabelsItsTiersAndTheWordThatItsLevelIsAssumed()
        {
            HapticModelAsset model = ImportedModel(out string path);
            Assert.That(AssetImporter.GetImportLog(path)?.logEntries.Length ?? 0, Is.Zero);
            Assert.That(model.Header.Tiers.Select(tier => tier.Name),
                Is.EqualTo(new[] { "published-1-unguided", "published-1", "published" }));
            Assert.That(model.Header.Labels.Select(label => label.Name), Is.SupersetOf(new[] { "wool felt", "wood" }));
            Assert.That(ModelSummary.Of(model).Rows.Single(row => row.Name == "Level").Value,
                Is.EqualTo("level assumed"));
        }

        [TestCase(HapticQuality.Standard, "published")]
        [TestCase(HapticQuality.Draft, "published-1-unguided")]
        public void AStrokeOverTheFirstSceneSoundsFromItsNetworkAndEndsInSilence(HapticQuality quality, string tier)
        {
            HaptoFlowSettings settings = Settings();
            settings.Model = ImportedModel(out _);
            settings.Quality = quality;
            Camera camera = MainCamera();
            CreateMenu.CreateFirstScene(new MenuCommand(null));
            EditorSession.Play();
            HapticSession session = HapticSession.Current;
            session.FinishLoading();
            Transform plate = All<HapticSurface>().Single().transform;
            AudioDevice.Forget();
            SimulatedInput.MouseButton = true;
            Frames(StrokeFrames, frame => SimulatedInput.MousePosition = camera.WorldToScreenPoint(
                plate.position + new Vector3(0.01f * (float)Math.Sin(6.0 * frame / World.FrameRateHz),
                    0.5f * plate.lossyScale.y, 0f)));
            int stroked = AudioDevice.RecordedFrames;
            double rms = Math.Sqrt(Enumerable.Range(stroked / 2, stroked / 2)
                .Average(frame => Math.Pow(AudioDevice.Sample(frame, 0), 2)));
            SimulatedInput.MouseButton = false;
            Frames(60, _ => { });
            float after = Enumerable.Range(AudioDevice.RecordedFrames - 4800, 4800)
                .Max(frame => Math.Abs(AudioDevice.Sample(frame, 0)));
            Assert.That(rms, Is.GreaterThan(1e-4), "stroke");
            Assert.That(after, Is.Zero, "lifted");
            EngineStatistics found = session.Engine!.Statistics();
            Assert.That(settings.Model.Header.Tiers[(int)found.Tier].Name, Is.EqualTo(tier));
            Assert.That(settings.Model.Header.TierOf(quality).Name, Is.EqualTo(tier));
            Assert.That(found.Segments, Is.GreaterThan(20));
        }

        private static HapticModelAsset ImportedModel(out string path)
        {
            byte[] file = File.ReadAllBytes(RepositoryFiles.In("Tests", "Golden", "model", "published.haptoflow"));
            path = Import("published.haptoflow", file);
            return AssetDatabase.LoadAssetAtPath<HapticModelAsset>(path);
        }
    }

    /// <summary>A test that plays with an engine that has no worker: it generates once a frame.</summary>
    public abstract class PlayedTest : EditorTest
    {
        [SetUp]
        public void StepTheEngine()
        {
            HapticSession.OptionsOverride = new HapticEngineOptions { WithoutWorker = true, FixedLeadMs = 8.0, Seed = 3 };
            HeldDevices.Reset();
            SimulatedInput.Reset();
        }

        [TearDown]
        public void StopPlaying()
        {
            if (Application.isPlaying)
            {
                EditorSession.Stop();
            }
            HapticSession.OptionsOverride = null;
            HeldDevices.Reset();
            SimulatedInput.Reset();
        }

        /// <summary>The camera of a new scene, with a listener.</summary>
        internal Camera MainCamera()
        {
            GameObject owner = Make("Main Camera");
            owner.tag = "MainCamera";
            owner.transform.position = new Vector3(0f, 1f, -10f);
            owner.AddComponent<AudioListener>();
            return owner.AddComponent<Camera>();
        }

        /// <param name="move">Called before each frame with its number.</param>
        internal static void Frames(int count, Action<int> move)
        {
            for (int frame = 0; frame < count; ++frame)
            {
                move(frame);
                World.Frame();
                HapticSession.Current.Engine!.Step();
            }
        }
    }
}
