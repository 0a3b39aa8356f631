#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Threading;
using HaptoFlow.Model;
using HaptoFlow.Recordings;

namespace HaptoFlow.Preview
{
    /// <summary>A recording and the material learnt from it, to be compared. Immutable once submitted.</summary>
    /// <param name="ModelFile">Bytes of a whole .haptoflow file. Models are compared by reference.</param>
    /// <param name="Recording">Recordings are compared by reference.</param>
    internal sealed record ComparisonRequest(byte[] ModelFile, Recording Recording)
    {
        /// <summary>The text of the learnt material's file; empty before one was learnt.</summary>
        public string Material { get; set; } = "";

        /// <summary>Angle from the recording's first axis to the material's, perpendicular to its ribs.</summary>
        public double TurnDegrees { get; set; }

        /// <summary>True to play the result at the recording's level.</summary>
        public bool MatchesLevels { get; set; }

        /// <summary>Index of the sound that is played: 0 for the recording, 1 for the result.</summary>
        public int Active { get; set; }
    }

    /// <summary>The output of a comparison. Immutable by convention.</summary>
    /// <param name="Sounds">The recording, and after it the result if there is one.</param>
    /// <param name="Problem">Why the result cannot be rendered; null if it can, or if there is none yet.</param>
    internal sealed record ComparisonResult(
        ComparisonRequest Request, IReadOnlyList<AnalysedSound> Sounds, string? Problem)
    {
        public SoundPanel Panel { get; } = new SoundPanel(Sounds);

        public int Active => Math.Min(Request.Active, Sounds.Count - 1);
    }

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
                    Material = LabelBlend.Of(engines.Register(request.Material)),
                    Effects = HapticEffects.Texture,
                };
                Stroke stroke = RecordingSound.StrokeOf(request.Recording, request.TurnDegrees);
                float[] samples = StrokeRenderer.Render(engine, stroke, surface, null, token);
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

    /// <summary>Converts a recording for comparison with the material learnt from it: one axis, 10 to 1000 Hz, at the
    /// preview's sample rate; and the stroke that it was made with.</summary>
    internal static class RecordingSound
    {
        /// <summary>A longer recording is cut off here.</summary>
        public const double MaximumSeconds = 10.0;

        /// <summary>The first <see cref="MaximumSeconds"/> of a recording.</summary>
        public static PreviewSound Of(Recording recording, Stroke stroke)
        {
            float[] sound = Waves.Resampled(recording.Wave(MaximumSeconds), Waves.RateHz, PreviewSound.RateHz);
            return new PreviewSound(new LabelMix("recording"), stroke,
                Array.ConvertAll(sound, sample => sample / PreviewSound.FullScaleMps2));
        }

        /// <summary>The motion of the recording as one touch over its whole length.</summary>
        /// <param name="turnDegrees">Angle from the recording's first axis to the stroke's.</param>
        public static Stroke StrokeOf(Recording recording, double turnDegrees = 0.0)
        {
            double cosine = Math.Cos(turnDegrees * Math.PI / 180.0);
            double sine = Math.Sin(turnDegrees * Math.PI / 180.0);
            double seconds = Math.Min(recording.Seconds, MaximumSeconds);
            double x = 0.0;
            double y = 0.0;
            return new Stroke(time =>
            {
                int sample = Math.Min(recording.SampleCount - 1, (int)(time * recording.SampleRateHz));
                (double recordedX, double recordedY) = recording.VelocityAt(sample);
                double velocityX = cosine * recordedX + sine * recordedY;
                double velocityY = cosine * recordedY - sine * recordedX;
                x += velocityX / Stroke.UpdateRateHz;
                y += velocityY / Stroke.UpdateRateHz;
                return new StrokeState
                {
                    XMetres = x,
                    YMetres = y,
                    VelocityXMps = velocityX,
                    VelocityYMps = velocityY,
                    ForceNewtons = recording.ForceAt(sample),
                    Touching = true,
                };
            }, seconds, true);
        }
    }
}
