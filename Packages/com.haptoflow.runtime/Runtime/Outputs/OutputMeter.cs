#nullable enable
using System;
using System.Diagnostics;

namespace HaptoFlow
{
    /// <summary>Level and render time of an output's last blocks: written by the audio thread, read by any
    /// thread.</summary>
    internal sealed class OutputMeter
    {
        private const float FallPerBlock = 0.9f;

        private volatile float peak;
        private volatile float milliseconds;
        private volatile float worstMilliseconds;
        private long beganTicks;
        private volatile DeviceCheck.BlockRecorder? recorder;

        /// <summary>Peak magnitude, which decays within some blocks.</summary>
        public float Peak => peak;

        /// <summary>Render time of the last block.</summary>
        public float Milliseconds => milliseconds;

        public float WorstMilliseconds => worstMilliseconds;

        /// <summary>Records every block; null for none. Main thread.</summary>
        public DeviceCheck.BlockRecorder? Recorder
        {
            set => recorder = value;
        }

        public void Begin()
        {
            recorder?.Begin();
            beganTicks = Stopwatch.GetTimestamp();
        }

        public void End(ReadOnlySpan<float> samples, int channels, int channel)
        {
            milliseconds = (float)((Stopwatch.GetTimestamp() - beganTicks) * 1000.0 / Stopwatch.Frequency);
            worstMilliseconds = Math.Max(worstMilliseconds, milliseconds);
            recorder?.End(milliseconds);
            float largest = 0f;
            for (int index = Math.Max(0, channel); index < samples.Length; index += channel < 0 ? 1 : channels)
            {
                largest = Math.Max(largest, Math.Abs(samples[index]));
            }
            peak = Math.Max(largest, peak * FallPerBlock);
        }
    }
}
