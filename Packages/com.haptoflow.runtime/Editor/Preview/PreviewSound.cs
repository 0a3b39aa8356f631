#nullable enable
using System;
using System.Threading;

namespace HaptoFlow.Preview
{
    /// <summary>The vibration of a stroke on a material, as samples. Immutable by convention; any thread.</summary>
    internal sealed class PreviewSound
    {
        public const int RateHz = 48000;

        /// <summary>Full scale: acceleration of a sample of 1, in m/s^2.</summary>
        public const float FullScaleMps2 = (float)HapticEngineOptions.DefaultFullScaleMps2;

        /// <param name="samples">In units of <see cref="FullScaleMps2"/>, -1 to 1.</param>
        /// <param name="device">The device that plays them.</param>
        public PreviewSound(
            LabelMix material, Stroke stroke, float[] samples, PreviewDevice device = PreviewDevice.Actuator)
        {
            Title = device == PreviewDevice.Actuator ? material.Title : DeviceRendering.NameOf(device);
            Material = material;
            Stroke = stroke;
            Samples = samples;
            double squares = 0.0;
            long touched = 0;
            for (int index = 0; index < samples.Length; ++index)
            {
                float size = Math.Abs(samples[index]);
                Peak = Math.Max(Peak, size);
                if (stroke.At(index / (double)RateHz).Touching)
                {
                    squares += size * size;
                    ++touched;
                }
            }
            RmsMps2 = FullScaleMps2 * Math.Sqrt(squares / Math.Max(1, touched));
        }

        public string Title { get; }
        public LabelMix Material { get; }
        public Stroke Stroke { get; }

        /// <summary>One channel in units of <see cref="FullScaleMps2"/>, -1 to 1.</summary>
        public float[] Samples { get; }

        public double DurationSeconds => Samples.Length / (double)RateHz;

        /// <summary>Largest magnitude, 0 to 1.</summary>
        public float Peak { get; }

        public double PeakMps2 => FullScaleMps2 * Peak;

        public double RmsMps2 { get; }
    }

    /// <summary>Renders a stroke with a voice, not in real time.</summary>
    internal static class StrokeRenderer
    {
        /// <summary>Renders each contact state in the order of the native offline renderer: publish the state, render
        /// its first sample, run inference, render the samples up to the next state. Never the main thread.</summary>
        /// <param name="engine">Without worker. If no voice was opened in it before and its lead is fixed, the samples
        /// depend only on stroke and seed.</param>
        /// <param name="surface">Material, effects, feature scale, tone of the surface; its motion is ignored.</param>
        /// <param name="relief">The relief of the surface, which says where each state lies in its map; null for
        /// none.</param>
        /// <returns>Samples at <see cref="PreviewSound.RateHz"/>, as long as the stroke.</returns>
        /// <exception cref="OperationCanceledException">The token was cancelled.</exception>
        public static float[] Render(
            HapticEngine engine, Stroke stroke, in ContactState surface, PreviewRelief? relief,
            CancellationToken token)
        {
            using HapticVoice voice = engine.OpenVoice(PreviewSound.RateHz);
            var samples = new float[Frames(stroke.DurationSeconds)];
            for (int index = 0; index < stroke.States.Count; ++index)
            {
                token.ThrowIfCancellationRequested();
                int begin = Frames(index / Stroke.UpdateRateHz);
                int end = Frames((index + 1) / Stroke.UpdateRateHz);
                Span<float> block = samples.AsSpan(begin, end - begin);
                StrokeState state = stroke.States[index];
                ContactState contact = state.ContactOn(surface);
                contact.ReliefPlace = relief?.PlaceOf(state) ?? default;
                voice.Publish(contact);
                voice.Render(block.Slice(0, 1), 1, 0, PreviewSound.RateHz);
                engine.Step();
                voice.Render(block.Slice(1), 1, 0, PreviewSound.RateHz);
            }
            ThrowIfFailed(voice.Statistics());
            return samples;
        }

        private static int Frames(double seconds) => (int)Math.Round(seconds * PreviewSound.RateHz);

        private static void ThrowIfFailed(in VoiceStatistics statistics)
        {
            if (statistics.Failures > 0)
            {
                throw new HaptoFlowException(HaptoFlowStatus.InferenceFailed,
                    $"the network failed {statistics.Failures} times in this stroke: import the model again");
            }
        }
    }
}
