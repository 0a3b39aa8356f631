#nullable enable
using System;
using System.Threading;

namespace HaptoFlow.Preview
{
    /// <summary>Lets a voice follow a stroke outside of real time.</summary>
    internal static class StrokeRenderer
    {
        /// <summary>Contact state, its first sample, inference, the samples up to the next state: the order in which
        /// the offline renderer takes the ends of a voice. A thread that can wait for networks.</summary>
        /// <param name="engine">Without worker. Fresh (no voice opened before) and with a fixed lead, it makes the same
        /// samples from the same stroke and seed every time.</param>
        /// <param name="surface">What the surface says: material, effects, scale and tone.</param>
        /// <returns>Samples of +-1 at <see cref="PreviewSound.RateHz"/>, as long as the stroke.</returns>
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
