#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
    /// <summary>Makes results from requests, and keeps what the next request is likely to want again. One thread at a
    /// time, one that can wait for networks.</summary>
    internal sealed class PreviewWorker : IDisposable
    {
        private readonly PreviewEngines engines = new PreviewEngines();
        private readonly List<(SoundKey Key, AnalysedSound Sound)> kept = new List<(SoundKey, AnalysedSound)>();
        private readonly Dictionary<string, TierTiming> timings = new Dictionary<string, TierTiming>();
        private byte[]? timedFile;
        private int timedMeasurement;

        /// <summary>Engines made so far.</summary>
        public int EnginesMade => engines.Made;

        /// <summary>A missing library, a damaged model or an unknown label becomes the result's problem.</summary>
        /// <exception cref="OperationCanceledException">The token was cancelled.</exception>
        public PreviewResult Do(PreviewRequest request, CancellationToken token)
        {
            IReadOnlyList<AnalysedSound> sounds = Array.Empty<AnalysedSound>();
            IReadOnlyList<QualityRow> qualities = Array.Empty<QualityRow>();
            string? problem = null;
            try
            {
                ModelHeader header = ModelHeader.Read(request.ModelFile);
                qualities = QualityRow.Of(header, new Dictionary<string, TierTiming>());
                var names = new LabelNames(header.Labels.Select(label => label.Name));
                sounds = request.Materials.Select(material => Sound(request, material, names, token)).ToArray();
                Forget(request, sounds);
                sounds = Through(request.Device, sounds, token);
                Measure(request, header, token);
                qualities = QualityRow.Of(header, timings);
            }
            catch (HaptoFlowException error)
            {
                problem = error.Message;
                sounds = Array.Empty<AnalysedSound>();
            }
            token.ThrowIfCancellationRequested();
            return new PreviewResult(request, sounds)
            {
                Qualities = qualities,
                Problem = problem,
            };
        }

        public void Dispose() => engines.Dispose();

        private AnalysedSound Sound(
            PreviewRequest request, LabelMix material, LabelNames names, CancellationToken token)
        {
            var key = new SoundKey(request, material);
            AnalysedSound? known = kept.Where(each => each.Key.Serves(key)).Select(each => each.Sound).FirstOrDefault();
            if (known != null)
            {
                return known;
            }
            HapticEngine engine = engines.Engine(
                request.ModelFile, QualityOf(request.Tier), request.Seed, !request.IsSketch);
            int own = material.IsOwn
                ? engines.MaterialIndex(material.MaterialText(request.ModelFile, request.Sliders))
                : -1;
            var surface = new ContactState
            {
                Material = material.In(names, own),
                Effects = request.Effects,
                SpatialScale = material.FeatureScale,
                ToneDbPerOctave = material.ToneDbPerOctave,
            };
            float[] samples = StrokeRenderer.Render(engine, request.Stroke, surface, token);
            AnalysedSound made = AnalysedSound.Of(new PreviewSound(material, request.Stroke, samples), token);
            kept.Add((key, made));
            return made;
        }

        /// <summary>The first material's wave, and behind it what a device makes of that.</summary>
        private static IReadOnlyList<AnalysedSound> Through(
            PreviewDevice device, IReadOnlyList<AnalysedSound> sounds, CancellationToken token)
        {
            if (device == PreviewDevice.Actuator || sounds.Count == 0)
            {
                return sounds;
            }
            PreviewSound played = DeviceRendering.Played(sounds[0].Sound, device, token);
            return new[] { sounds[0], AnalysedSound.Of(played, token) };
        }

        /// <summary>Only what is shown stays.</summary>
        private void Forget(PreviewRequest request, IReadOnlyList<AnalysedSound> shown) =>
            kept.RemoveAll(each => !shown.Contains(each.Sound));

        /// <summary>Not while a control is held: it would make waiting longer.</summary>
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
            float[] embedding = engines.Embedding(request.ModelFile);
            foreach (ModelTier tier in header.Tiers)
            {
                using HapticGenerator generator = engines.Generator(request.ModelFile, tier.Name);
                timings[tier.Name] = TierTiming.Measure(generator, embedding, token);
            }
            timedMeasurement = request.Measurement;
        }

        /// <exception cref="HaptoFlowException">The engine has no name for such a tier.</exception>
        private static HapticQuality QualityOf(string tier) => tier switch
        {
            "draft" => HapticQuality.Draft,
            "standard" => HapticQuality.Standard,
            "fine" => HapticQuality.Fine,
            _ => throw new HaptoFlowException(HaptoFlowStatus.InvalidArgument,
                $"tier \"{tier}\" cannot be previewed; expected draft, standard or fine"),
        };

        /// <summary>What a sound depends on.</summary>
        private readonly struct SoundKey
        {
            private readonly byte[] modelFile;
            private readonly Stroke stroke;
            private readonly LabelMix material;
            private readonly string tier;
            private readonly ulong seed;
            private readonly bool isSketch;
            private readonly HapticEffects effects;

            public SoundKey(PreviewRequest request, LabelMix material)
            {
                modelFile = request.ModelFile;
                stroke = request.Stroke;
                this.material = material;
                tier = request.Tier;
                seed = request.Seed;
                isSketch = request.IsSketch;
                effects = request.Effects;
            }

            /// <summary>A sketch does where a sketch is wanted; the real thing always does.</summary>
            public bool Serves(in SoundKey wanted) =>
                ReferenceEquals(modelFile, wanted.modelFile) && ReferenceEquals(stroke, wanted.stroke) &&
                material.Equals(wanted.material) && tier == wanted.tier && seed == wanted.seed &&
                effects == wanted.effects &&
                (!isSketch || wanted.isSketch);
        }
    }
}
