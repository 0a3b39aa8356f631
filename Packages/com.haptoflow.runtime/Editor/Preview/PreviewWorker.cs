#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using System.Threading.Tasks;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
    /// <summary>Renders and analyses the sounds of requests, and keeps those of the last request for the next one. One
    /// thread at a time, never the main thread.</summary>
    internal sealed class PreviewWorker : IDisposable
    {
        private readonly PreviewEngines engines = new PreviewEngines();
        private readonly List<(PreviewRequest Request, AnalysedSound Sound)> kept =
            new List<(PreviewRequest, AnalysedSound)>();
        private readonly Dictionary<string, TierTiming> timings = new Dictionary<string, TierTiming>();
        private byte[]? timedFile;
        private int timedMeasurement;

        /// <summary>Makes the result of a request. A missing library, a damaged model or an unknown label is reported
        /// as the result's problem.</summary>
        public PreviewResult Do(PreviewRequest request, CancellationToken token)
        {
            IReadOnlyList<AnalysedSound> sounds = Array.Empty<AnalysedSound>();
            IReadOnlyList<QualityRow> qualities = Array.Empty<QualityRow>();
            HeightCurve? heights = null;
            string? problem = null;
            try
            {
                ModelHeader header = engines.Model(request.ModelFile).Header;
                qualities = QualityRow.Of(header, new Dictionary<string, TierTiming>());
                var names = new LabelNames(header.Labels.Select(label => label.Name));
                sounds = request.Materials.Select(material => Sound(request, material, names, token)).ToArray();
                KeepOnly(sounds);
                sounds = Through(request.Device, sounds, token);
                heights = request.Relief != null ? new HeightCurve(request.Stroke, request.Relief) : null;
                Measure(request, header, token);
                qualities = QualityRow.Of(header, timings);
            }
            catch (HaptoFlowException error)
            {
                problem = error.Message;
                sounds = Array.Empty<AnalysedSound>();
            }
            token.ThrowIfCancellationRequested();
            return new PreviewResult(request, sounds, qualities, problem, heights);
        }

        public void Dispose() => engines.Dispose();

        private AnalysedSound Sound(
            PreviewRequest request, LabelMix material, LabelNames names, CancellationToken token)
        {
            AnalysedSound? known = kept
                .Where(each => each.Sound.Sound.Material.Equals(material) && CanServe(each.Request, request))
                .Select(each => each.Sound).FirstOrDefault();
            if (known != null)
            {
                return known;
            }
            HapticEngine engine = engines.Engine(
                request.ModelFile, PreviewQualities.Of(engines.Model(request.ModelFile).Header, request.Tier), request.Seed,
                !request.IsSketch);
            int registered = material.IsRegistered
                ? engines.Register(material.MaterialText(engines.Model(request.ModelFile), request.Sliders))
                : -1;
            uint relief = engines.Relief(request.Relief);
            var surface = new ContactState
            {
                Material = material.ToBlend(names, registered),
                Effects = relief == 0
                    ? request.Effects
                    : (request.Effects & ~HapticEffects.Nothing) | HapticEffects.Relief,
                SpatialScale = material.FeatureScale,
                ToneDbPerOctave = material.ToneDbPerOctave,
                Relief = relief,
                ReliefShare = request.Relief?.Share ?? 0f,
            };
            float[] samples = StrokeRenderer.Render(engine, request.Stroke, surface, request.Relief, token);
            AnalysedSound made = AnalysedSound.Of(new PreviewSound(material, request.Stroke, samples), token);
            kept.Add((request, made));
            return made;
        }

        /// <summary>The first material's sound, and after it what the device plays for it.</summary>
        private static IReadOnlyList<AnalysedSound> Through(
            PreviewDevice device, IReadOnlyList<AnalysedSound> sounds, CancellationToken token)
        {
            if (device == PreviewDevice.Actuator || sounds.Count == 0)
            {
                return sounds;
            }
            PreviewSound played = DeviceRendering.Render(sounds[0].Sound, device, token);
            return new[] { sounds[0], AnalysedSound.Of(played, token) };
        }

        private void KeepOnly(IReadOnlyList<AnalysedSound> shown) =>
            kept.RemoveAll(each => !shown.Contains(each.Sound));

        /// <summary>Times the tiers if the request says so; never for a sketch, which must be quick.</summary>
        private void Measure(PreviewRequest request, ModelHeader header, CancellationToken token)
        {
            if (!ReferenceEquals(timedFile, request.ModelFile))
            {
                timings.Clear();
                timedMeasurement = 0;
                timedFile = request.ModelFile;
            }
            if (request.IsSketch || request.Measurement == timedMeasurement)
            {
                return;
            }
            float[] embedding = engines.Model(request.ModelFile).Embedding(0);
            foreach (HapticTier tier in header.Tiers)
            {
                using HapticGenerator generator = engines.Generator(request.ModelFile, tier.Name);
                timings[tier.Name] = TierTiming.Measure(generator, embedding, token);
            }
            timedMeasurement = request.Measurement;
        }

        /// <summary>True if the sounds of a request can be used for another one, as far as they do not depend on the
        /// material. A sketch can only be used for a sketch.</summary>
        private static bool CanServe(PreviewRequest made, PreviewRequest wanted) =>
            ReferenceEquals(made.ModelFile, wanted.ModelFile) && ReferenceEquals(made.Stroke, wanted.Stroke) &&
            made.Tier == wanted.Tier && made.Seed == wanted.Seed && made.Effects == wanted.Effects &&
            Equals(made.Relief, wanted.Relief) && (!made.IsSketch || wanted.IsSketch);
    }

    /// <summary>The input of a preview. Immutable by convention once submitted.</summary>
    /// <param name="ModelFile">Bytes of a whole .haptoflow file. Models are compared by reference.</param>
    /// <param name="Stroke">Strokes are compared by reference.</param>
    /// <param name="Materials">One, or two to compare.</param>
    internal sealed record PreviewRequest(byte[] ModelFile, Stroke Stroke, IReadOnlyList<LabelMix> Materials)
    {
        public SliderSet? Sliders { get; set; }
        public int Active { get; set; }

        /// <summary>Name of a tier of the model, one of <see cref="PreviewQualities.Tiers"/>.</summary>
        public string Tier { get; set; } = "standard";

        public HapticEffects Effects { get; set; } = HapticEffects.Texture;

        /// <summary>The heights under the stroke; null for an even surface.</summary>
        public PreviewRelief? Relief { get; set; }

        /// <summary>If this is not an actuator, its sound is shown beside the first material's.</summary>
        public PreviewDevice Device { get; set; }

        public ulong Seed { get; set; } = 1;

        /// <summary>True while a control is dragged: a used engine may render, whose noise differs from a fresh one's.
        /// </summary>
        public bool IsSketch { get; set; }

        /// <summary>The tiers are timed when this number differs from that of the last timing; 0 for never.</summary>
        public int Measurement { get; set; }
    }

    /// <summary>The output of a preview. Immutable by convention.</summary>
    /// <param name="Sounds">As many as the request has materials, and one more if a device renders the first; none if
    /// there is a problem.</param>
    /// <param name="Qualities">One for each tier; none if the model cannot be read.</param>
    /// <param name="Problem">Why there is no sound; null if there is one.</param>
    /// <param name="Heights">Under the tip; null without a relief.</param>
    internal sealed record PreviewResult(PreviewRequest Request, IReadOnlyList<AnalysedSound> Sounds,
        IReadOnlyList<QualityRow> Qualities, string? Problem, HeightCurve? Heights)
    {
        public SoundPanel Panel { get; } = new SoundPanel(Sounds, Heights);
    }

    /// <summary>The tiers of a model that an engine plays at one of its fixed qualities: those can be previewed.</summary>
    internal static class PreviewQualities
    {
        private static readonly HapticQuality[] Fixed =
        {
            HapticQuality.Sketch, HapticQuality.Draft, HapticQuality.Standard,
        };

        public static string[] Tiers(ModelHeader header) => header.Tiers.Select(tier => tier.Name)
            .Where(name => Fixed.Any(quality => Plays(header, quality, name))).ToArray();

        /// <summary>The quality that plays one of <see cref="Tiers"/>.</summary>
        public static HapticQuality Of(ModelHeader header, string tier) =>
            Fixed.First(quality => Plays(header, quality, tier));

        private static bool Plays(ModelHeader header, HapticQuality quality, string tier) =>
            header.TierOf(quality).Name == tier;
    }

    /// <summary>Works on one request at a time in the background. Of the requests submitted meanwhile only the newest
    /// is kept. Call all methods from one thread.</summary>
    internal sealed class LatestTask<TRequest, TResult> : IDisposable
        where TRequest : class
        where TResult : class
    {
        private readonly Func<TRequest, CancellationToken, TResult> work;
        private readonly CancellationTokenSource ending = new CancellationTokenSource();
        private TRequest? waiting;
        private Task<TResult>? running;

        /// <param name="work">Runs in the background, never twice at the same time.</param>
        public LatestTask(Func<TRequest, CancellationToken, TResult> work) => this.work = work;

        public bool IsBusy => running != null || waiting != null;

        /// <summary>Starts a request, or keeps it until the running one is finished.</summary>
        public void Submit(TRequest request)
        {
            waiting = request;
            StartNext();
        }

        /// <summary>Takes the finished result, and starts the waiting request.</summary>
        /// <returns>Null if nothing was finished since the last call.</returns>
        /// <exception cref="Exception">The exception that the work threw.</exception>
        public TResult? Poll()
        {
            if (running == null || !running.IsCompleted)
            {
                return null;
            }
            Task<TResult> finished = running;
            running = null;
            StartNext();
            return finished.GetAwaiter().GetResult();
        }

        /// <summary>Blocks until the running request ends. <see cref="Poll"/> then starts the waiting one.</summary>
        public void Wait()
        {
            if (running != null)
            {
                ((IAsyncResult)running).AsyncWaitHandle.WaitOne();
            }
        }

        /// <summary>Cancels the running request and waits until it ends, because native calls must not outlive a domain
        /// reload.</summary>
        public void Dispose()
        {
            waiting = null;
            ending.Cancel();
            Wait();
            running = null;
            ending.Dispose();
        }

        private void StartNext()
        {
            if (running != null || waiting == null)
            {
                return;
            }
            TRequest request = waiting;
            waiting = null;
            CancellationToken token = ending.Token;
            running = Task.Run(() => work(request, token));
        }
    }
}
