#nullable enable
using System;
using HaptoFlow.Outputs;

namespace HaptoFlow
{
    /// <summary>The voices of a device output, as the source of its queue. Main thread.</summary>
    internal sealed class VoiceSource : IWaveSource
    {
        // A voice falls silent within 5 ms.
        private const double ClosingSeconds = 0.01;

        private readonly VoiceMixer mixer = new VoiceMixer();
        private readonly float[] closing = new float[(int)(ClosingSeconds * WaveHistory.RateHz)];

        /// <inheritdoc/>
        public bool IsStopped => mixer.AllAreStopped();

        public void Add(HapticVoice voice) => mixer.Add(voice);

        public void ForEach<T>(Action<HapticVoice, T> act, T argument) => mixer.ForEach(act, argument);

        /// <summary>Renders and discards as many samples as a voice needs to fall silent.</summary>
        public void Discard() => Render(closing);

        /// <summary>Discards impacts and edges that came while no device could play them.</summary>
        /// <param name="staysPaused">True where the output is paused, and its voices with it.</param>
        public void Forget(bool staysPaused)
        {
            ForEach((voice, _) => voice.SetPaused(true), 0);
            Discard();
            ForEach((voice, stays) => voice.SetPaused(stays), staysPaused);
        }

        /// <inheritdoc/>
        public void Render(Span<float> samples)
        {
            using (Markers.Render.Auto())
            {
                mixer.Render(samples, 1, 0, (int)WaveHistory.RateHz);
            }
        }
    }
}
