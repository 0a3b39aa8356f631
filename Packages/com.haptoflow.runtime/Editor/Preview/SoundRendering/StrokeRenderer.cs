#nullable enable
using System;
using System.Threading;

namespace HaptoFlow.Preview
{
    /// <summary>Renders a stroke with a voice, not in real time.</summary>
    internal static class StrokeRenderer
    {
        /// <summary>Renders each contact state in the order of the native offline renderer: publish the state, render
        /// its first sample, run inference, render the samples up to the next state. Never the main thread.</summary>
        /// <param name="engine">Without worker. If no voice was opened in it before and its lead is fixed, the samples
        /// depend only on stroke and seed.</param>
        /// <param name="surface">Material, effects, feature scale, tone of the surface; its motion is ignored.</param>
        /// <returns>Samples at <see cref="PreviewSound.RateHz"/>, as long as the stroke.</returns>
        /// <exception cref="OperationCanceledException">The token was cancelled.</exception>
        public static float[] Render(
            HapticEngine engine, Stroke stroke, in ContactState surface, CancellationToken token)
        {
            using HapticVoice voice = engine.OpenVoice(PreviewSound.RateHz);
            var samples = new float[Frames(stroke.DurationSeconds)];
            for (int index = 0; index < stroke.States.Count; ++index)
            {
                token.ThrowIfCancellationRequested();
                int begin = Frames(index / Stroke.UpdateRateHz);
                int end = Frames((index + 1) / Stroke.UpdateRateHz);
                Span<float> block = samples.AsSpan(begin, end - begin);
                voice.Publish(stroke.States[index].ContactOn(surface));
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
