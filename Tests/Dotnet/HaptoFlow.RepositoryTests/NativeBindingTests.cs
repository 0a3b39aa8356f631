using System;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Runtime.InteropServices;
using HaptoFlow.Native;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    public sealed class NativeBindingTests : OpenModelTest
    {
        [Test]
        public void EveryStructOfTheHeaderIsComparedWithTheLibrary()
        {
            string header = File.ReadAllText(RepositoryFiles.In("NativePlugin", "include", "haptoflow", "haptoflow.h"));
            string[] declared = System.Text.RegularExpressions.Regex
                .Matches(header, @"typedef struct (haptoflow_\w+) \{")
                .Select(match => match.Groups[1].Value).ToArray();
            Assert.That(LibraryAgreement.Structs.Keys, Is.EquivalentTo(declared));
            Assert.DoesNotThrow(LibraryAgreement.Require);
        }

        [Test]
        public void TheScriptsHaveThePackagesVersion() => Assert.That(
            (string?)Newtonsoft.Json.Linq.JObject.Parse(File.ReadAllText(
                RepositoryFiles.In("Packages", "com.haptoflow.runtime", "package.json")))["version"],
            Is.EqualTo(LibraryAgreement.Version).And.EqualTo(OnnxRuntime.LibraryVersion()));

        [Test]
        public void NativeStructsAndCallbacksArePreservedFromStripping()
        {
            const BindingFlags anyField = BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;
            Type[] crossing = typeof(NativeMethods).Assembly.GetTypes()
                .Where(type => type == typeof(NativeMethods) || type.GetField("StructSize", anyField) != null)
                .ToArray();
            Assert.That(crossing, Has.Length.GreaterThan(11));
            Assert.That(crossing, Has.All.Matches<Type>(type => type.IsDefined(typeof(PreserveAttribute), false)));
        }

        /// <summary>What only Python and the web call.</summary>
        private static readonly string[] OfOtherLanguages =
        {
            "haptoflow_engine_material_count", "haptoflow_find_wave_vectors", "haptoflow_generator_set_solver",
            "haptoflow_recording_create", "haptoflow_recording_remove_noise",
        };

        [Test]
        public void EveryFunctionOfTheHeaderIsDeclaredAndExported()
        {
            string header = System.Text.RegularExpressions.Regex.Replace(
                File.ReadAllText(RepositoryFiles.In("NativePlugin", "include", "haptoflow", "haptoflow.h")),
                @"/\*.*?\*/", "", System.Text.RegularExpressions.RegexOptions.Singleline);
            string[] declared = System.Text.RegularExpressions.Regex.Matches(header, @"HAPTOFLOW_API [^;]*?\b(haptoflow_\w+)\(")
                .Select(match => match.Groups[1].Value).OrderBy(name => name, StringComparer.Ordinal).ToArray();
            string[] bound = typeof(NativeMethods).GetMethods()
                .SelectMany(method => method.GetCustomAttributes(typeof(DllImportAttribute), false))
                .Select(attribute => ((DllImportAttribute)attribute).EntryPoint!)
                .Where(name => name.StartsWith("haptoflow_", StringComparison.Ordinal))
                .OrderBy(name => name, StringComparer.Ordinal).ToArray();
            Assert.That(bound, Is.EqualTo(declared.Except(OfOtherLanguages)));
            Assert.That(declared.Length, Is.GreaterThan(30));
        }

        [Test]
        public void AClosedModelIsRefused()
        {
            HapticModel closed = HapticModel.Open(RepositoryFiles.DefaultModel);
            closed.Dispose();
            closed.Dispose();
            var refusal = Assert.Throws<HaptoFlowException>(() => closed.Embedding(0));
            Assert.That(refusal!.Status, Is.EqualTo(HaptoFlowStatus.InvalidArgument));
        }

        [Test]
        public void AGeneratorIsOfTheDefaultTierOrOfOneThatIsThere()
        {
            new HapticGenerator(runtime, model).Dispose();
            Assert.That(Assert.Throws<HaptoFlowException>(() => new HapticGenerator(runtime, model, "superb"))!.Message,
                Does.Contain("superb"));
        }

        [Test]
        public void AClosedVoiceRendersSilenceAndRefusesStates()
        {
            using HapticEngine engine = EngineWithoutWorker();
            HapticVoice voice = engine.OpenVoice(48000.0);
            voice.Dispose();
            var block = Enumerable.Repeat(0.5f, 64).ToArray();
            Assert.That(voice.Render(block, 1, 0, 48000.0), Is.False);
            Assert.That(block, Is.All.Zero);
            Assert.Throws<HaptoFlowException>(() => voice.Publish(Sliding(1)));
            Assert.Throws<HaptoFlowException>(() => voice.SignalStatistics());
        }

        [Test]
        public void DisposingAnEngineClosesItsVoices()
        {
            HapticEngine engine = EngineWithoutWorker();
            HapticVoice voice = engine.OpenVoice(48000.0);
            engine.Dispose();
            var block = new float[64];
            Assert.That(voice.Render(block, 1, 0, 48000.0), Is.False);
            Assert.Throws<HaptoFlowException>(() => voice.Statistics());
            voice.Dispose();
        }

        [Test]
        public void ARegisteredMaterialFollowsTheLabelsAndCanBeReplaced()
        {
            string denim = File.ReadAllText(RepositoryFiles.In("Tests", "Golden", "material", "denim.haptomaterial"));
            Assert.That(denim, Does.Contain("\"" + model.Space + "\""));
            using HapticEngine engine = EngineWithoutWorker();
            using HapticVoice voice = engine.OpenVoice(48000.0);
            int index = engine.RegisterMaterial(denim);
            Assert.That(index, Is.EqualTo(model.Labels.Count));
            Assert.That(engine.Material(index).Name, Is.EqualTo("denim"));
            Assert.That(engine.Material(index).Index, Is.EqualTo(index));
            ContactState state = Sliding(1);
            state.Material = LabelBlend.Of(index);
            Assert.That(Peak(engine, voice, state, 20), Is.GreaterThan(0.002f));
            Assert.That(voice.EffectStatistics(HapticEffect.Tone).Runs, Is.GreaterThan(0UL));
            engine.ReplaceMaterial(index, denim.Replace("denim", "canvas"));
            Assert.That(engine.Material(index).Name, Is.EqualTo("canvas"));
            Assert.Throws<HaptoFlowException>(() => engine.ReplaceMaterial(index + 1, denim));
            Assert.Throws<HaptoFlowException>(() => engine.Material(index + 1));
        }

        private static float Peak(HapticEngine engine, HapticVoice voice, in ContactState state, int blocks)
        {
            var block = new float[512];
            float peak = 0f;
            for (int count = 0; count < blocks; ++count)
            {
                Assert.That(voice.Publish(state), Is.True);
                engine.Step();
                Assert.That(voice.Render(block, 1, 0, 48000.0), Is.True);
                peak = Math.Max(peak, block.Max(sample => Math.Abs(sample)));
            }
            return peak;
        }
    }

    /// <summary>Base class of tests with the real library and the shipped model, which is opened once.</summary>
    public abstract class OpenModelTest
    {
        protected OnnxRuntime runtime = null!;
        protected HapticModel model = null!;

        [OneTimeSetUp]
        public void Open()
        {
            runtime = OnnxRuntime.Open();
            model = HapticModel.Open(RepositoryFiles.DefaultModel);
        }

        private protected HapticEngine EngineWithoutWorker(HapticCancellation? cancellation = null) => new HapticEngine(
            runtime, model, new HapticEngineOptions
            {
                Quality = HapticQuality.Draft, WithoutWorker = true, FixedLeadMs = 8.0, Seed = 1,
                Cancellation = cancellation,
            });

        private protected static ContactState Sliding(uint touch) => new ContactState
        {
            Touching = true,
            TouchCounter = touch,
            Material = LabelBlend.Of(1),
            FirstVelocityMps = 0.05f,
            ForceNewtons = 0.6f,
        };

        [OneTimeTearDown]
        public void Close()
        {
            model.Dispose();
            runtime.Dispose();
        }
    }

    /// <summary>Reasons for silence, the health of the engine and cancelled loads, with the real library.</summary>
    public sealed class NativeHealthTests : OpenModelTest
    {
        [Test]
        public void AVoiceReportsWhyItIsSilent()
        {
            using HapticEngine engine = EngineWithoutWorker();
            using HapticVoice voice = engine.OpenVoice(48000.0);
            Assert.That(After(engine, voice, default, 48000.0).Silence, Is.EqualTo(HapticSilence.Rest));
            Assert.That(After(engine, voice, Sliding(1), 48000.0).Silence, Is.EqualTo(HapticSilence.None));
            voice.SetMuted(true);
            Assert.That(After(engine, voice, Sliding(1), 48000.0).Silence, Is.EqualTo(HapticSilence.Muted));
            voice.SetMuted(false);
            VoiceStatistics again = After(engine, voice, Sliding(1), 48000.0);
            Assert.That(again.Silence, Is.EqualTo(HapticSilence.None));
            Assert.That(again.Resumptions, Is.EqualTo(1UL));
            voice.Panic();
            Assert.That(After(engine, voice, Sliding(1), 48000.0).Silence, Is.EqualTo(HapticSilence.Panic));
            voice.SetPaused(true);
            Assert.That(After(engine, voice, Sliding(2), 48000.0).Silence, Is.EqualTo(HapticSilence.Paused));
            Assert.That(engine.Statistics().WorkerIsAlive, Is.True, "an engine without a worker lacks none");
            Assert.That(engine.LastFailure(), Is.Empty);
        }

        [Test]
        public void AnUnsupportedRateIsCountedAndReported()
        {
            using HapticEngine engine = EngineWithoutWorker();
            using HapticVoice voice = engine.OpenVoice(48000.0);
            VoiceStatistics good = After(engine, voice, Sliding(1), 48000.0);
            Assert.That(good.IsRateSupported, Is.True);
            Assert.That(good.DeviceRateHz, Is.EqualTo(48000.0));
            VoiceStatistics bad = After(engine, voice, Sliding(1), 384000.0);
            Assert.That(bad.IsRateSupported, Is.False);
            Assert.That(bad.Silence, Is.EqualTo(HapticSilence.Rate));
            Assert.That(bad.UnsupportedRateBlocks, Is.GreaterThan(0UL));
            Assert.That(bad.DeviceRateHz, Is.EqualTo(384000.0));
        }

        [TestCase(-1)]
        [TestCase(3)]
        [TestCase(5)]
        public void ANumberThatIsNoQualityIsRefusedByTheEngineAndIsStandardInAnAsset(int number)
        {
            using HapticEngine engine = EngineWithoutWorker();
            Assert.That(Assert.Throws<HaptoFlowException>(() => engine.SetQuality((HapticQuality)number))!.Message,
                Does.Contain(FormattableString.Invariant(
                    $"quality is {number}; expected 0 (auto), 1 (draft), 2 (standard) or 4 (sketch)")));
            Assert.That(((HapticQuality)number).OrStandard(), Is.EqualTo(HapticQuality.Standard));
        }

        [Test]
        public void EveryQualityThatThereIsStaysWhatItIs()
        {
            foreach (HapticQuality quality in (HapticQuality[])Enum.GetValues(typeof(HapticQuality)))
            {
                Assert.That(quality.OrStandard(), Is.EqualTo(quality));
            }
        }

        [Test]
        public void ACancelledLoadReturnsTheStatusCancelled()
        {
            using var cancellation = new HapticCancellation();
            using (EngineWithoutWorker(cancellation))
            {
                // A cancellation that is not triggered changes nothing.
            }
            cancellation.Cancel();
            cancellation.Cancel();
            Assert.That(Assert.Throws<HaptoFlowException>(() => EngineWithoutWorker(cancellation))!.Status,
                Is.EqualTo(HaptoFlowStatus.Cancelled));
        }

        [Test]
        public void AClosedCancellationIsRefused()
        {
            var cancellation = new HapticCancellation();
            cancellation.Dispose();
            cancellation.Dispose();
            Assert.That(Assert.Throws<HaptoFlowException>(() => cancellation.Cancel())!.Status,
                Is.EqualTo(HaptoFlowStatus.InvalidArgument));
        }

        private static VoiceStatistics After(
            HapticEngine engine, HapticVoice voice, in ContactState state, double rateHz)
        {
            var block = new float[512];
            for (int count = 0; count < 10; ++count)
            {
                voice.Publish(state);
                engine.Step();
                voice.Render(block, 1, 0, rateHz);
            }
            return voice.Statistics();
        }
    }

    /// <summary>Reliefs of the native library, as C# makes them and names them in contact states.</summary>
    public sealed class ReliefMapTests : OpenModelTest
    {
        private static readonly (float, float) Size = (0.1f, 0.1f);

        [Test]
        public void ATipFollowsTheHeightsAlongItsWayInTheMap()
        {
            using HapticReliefMap ribs = Ribs();
            double without = Level(0, (10.0, 0.0), 0.5f);
            double across = Level(ribs.Number, (10.0, 0.0), 0.5f);
            double along = Level(ribs.Number, (0.0, 10.0), 0.5f);
            Assert.That(without, Is.Zero, "the relief is the only effect");
            Assert.That(across, Is.GreaterThan(0.01));
            Assert.That(along, Is.LessThan(0.1 * across));
        }

        [Test]
        public void ADisposedReliefIsSilent()
        {
            HapticReliefMap ribs = Ribs();
            uint number = ribs.Number;
            ribs.Dispose();
            ribs.Dispose();
            Assert.That(number, Is.Not.Zero);
            Assert.That(ribs.Number, Is.Zero);
            Assert.That(Level(number, (10.0, 0.0), 0.5f), Is.Zero);
        }

        [Test]
        public void AMapWithoutColumnsIsRefused() => Assert.Throws<HaptoFlowException>(
            () => new HapticReliefMap(new float[4], 0, Size, 0.001f, 0f, true));

        /// <summary>A sine of 2 mm along the columns.</summary>
        private static HapticReliefMap Ribs() => new HapticReliefMap(
            Enumerable.Range(0, 800 * 2)
                .Select(texel => 1e-4f * (1f + (float)Math.Sin(2.0 * Math.PI * texel / 16.0))).ToArray(),
            800, Size, 0.0002f, 0.0005f, true);

        /// <summary>The RMS level of a tip that slides at 0.1 m/s, of full scale.</summary>
        private double Level(uint relief, (double Columns, double Rows) perMetre, float share)
        {
            using HapticEngine engine = EngineWithoutWorker();
            using HapticVoice voice = engine.OpenVoice(48000.0);
            ContactState state = Sliding(1);
            (state.FirstVelocityMps, state.SecondVelocityMps) = (0.1f, 0f);
            (state.Effects, state.Relief, state.ReliefShare) = (HapticEffects.Relief, relief, share);
            var block = new float[512];
            double squares = 0.0;
            for (int count = 0; count < 60; ++count)
            {
                double metres = 0.1 * 512.0 / 48000.0 * count;
                state.ReliefPlace = new MapPlace(perMetre.Columns * metres, perMetre.Rows * metres);
                Assert.That(voice.Publish(state), Is.True);
                engine.Step();
                voice.Render(block, 1, 0, 48000.0);
                squares += count < 20 ? 0.0 : block.Sum(sample => sample * sample);
            }
            return Math.Sqrt(squares / (40.0 * block.Length));
        }
    }
}
