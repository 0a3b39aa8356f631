#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Threading;
using HaptoFlow.Model;
using HaptoFlow.Recordings;

namespace HaptoFlow.Preview
{
    /// <summary>Renders a learnt material with the motion of its recording, and analyses both. One thread at a time,
    /// never the main thread.</summary>
    internal sealed class ComparisonWorker : IDisposable
    {
        private const ulong Seed = 1;

        private readonly PreviewEngines engines = new PreviewEngines();
        private Recording? analysed;
        private AnalysedSound? recording;
        private (byte[] Model, Recording Recording, string Material, double TurnDegrees) rendered;
        private PreviewSound? result;

        /// <exception cref="OperationCanceledException">The token was cancelled.</exception>
        public ComparisonResult Do(ComparisonRequest request, CancellationToken token)
        {
            if (recording == null || !ReferenceEquals(analysed, request.Recording))
            {
                Stroke stroke = RecordingSound.StrokeOf(request.Recording);
                recording = AnalysedSound.Of(RecordingSound.Of(request.Recording, stroke), token);
                analysed = request.Recording;
            }
            var sounds = new List<AnalysedSound> { recording };
            string? problem = null;
            if (request.Material.Length > 0)
            {
                try
                {
                    sounds.Add(AnalysedSound.Of(Shown(request, Result(request, token)), token));
                }
                catch (HaptoFlowException error)
                {
                    problem = error.Message;
                }
            }
            token.ThrowIfCancellationRequested();
            return new ComparisonResult(request, sounds, problem);
        }

        public void Dispose() => engines.Dispose();

        private PreviewSound Result(ComparisonRequest request, CancellationToken token)
        {
            (byte[], Recording, string, double) requested =
                (request.ModelFile, request.Recording, request.Material, request.TurnDegrees);
            if (result == null || !rendered.Equals(requested))
            {
                MaterialFile material = MaterialFile.Read(request.Material);
                HapticEngine engine = engines.Engine(request.ModelFile, HapticQuality.Standard, Seed, true);
                var surface = new ContactState
                {
                    Material = LabelBlend.Of(engines.MaterialIndex(request.Material)),
                    Effects = HapticEffects.Texture,
                };
                Stroke stroke = RecordingSound.StrokeOf(request.Recording, request.TurnDegrees);
                float[] samples = StrokeRenderer.Render(engine, stroke, surface, token);
                result = new PreviewSound(new LabelMix(material.Name), stroke, samples);
                rendered = requested;
            }
            return result;
        }

        /// <summary>The result, at the recording's level if requested; then the title names the gain.</summary>
        private PreviewSound Shown(ComparisonRequest request, PreviewSound sound)
        {
            if (!request.MatchesLevels || sound.RmsMps2 <= 0.0 || recording!.Sound.RmsMps2 <= 0.0)
            {
                return sound;
            }
            double gain = recording.Sound.RmsMps2 / sound.RmsMps2;
            string title = string.Format(CultureInfo.InvariantCulture, "{0} ({1:+0.0;-0.0;0.0} dB)", sound.Title,
                20.0 * Math.Log10(gain));
            return new PreviewSound(new LabelMix(title), sound.Stroke,
                Array.ConvertAll(sound.Samples, sample => (float)gain * sample));
        }
    }
}
