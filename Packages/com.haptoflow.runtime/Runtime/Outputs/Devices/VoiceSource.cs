#nullable enable
using System;
using HaptoFlow.Outputs;

namespace HaptoFlow
{
    /// <summary>The voices that play on a device output, as its queue sees them. Main thread.</summary>
    internal sealed class VoiceSource : IWaveSource
    {
        private readonly VoiceMixer mixer = new VoiceMixer();

        public VoiceSource() => mixer.Prepare((int)(WaveHistory.CapacitySeconds * WaveHistory.RateHz));

        /// <inheritdoc/>
        public bool IsStopped => mixer.AllAreStopped();

        public void Add(HapticVoice voice) => mixer.Add(voice);

        public void Remove(HapticVoice voice) => mixer.Remove(voice);

        public void ForEach<T>(Action<HapticVoice, T> act, T argument) => mixer.ForEach(act, argument);

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
