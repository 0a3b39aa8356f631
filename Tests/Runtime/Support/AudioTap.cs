#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.Tests
{
    /// <summary>Records the output of the filters above it on the same object.</summary>
    internal sealed class AudioTap : MonoBehaviour
    {
        private const int MostChannels = 8;
        private readonly float[] peaks = new float[MostChannels];
        private volatile int blocks;
        private volatile int broken;

        /// <summary>Blocks received since the last <see cref="Restart"/>.</summary>
        public int Blocks => blocks;

        /// <summary>Samples that are not finite or beyond +-1.</summary>
        public int BrokenSamples => broken;

        /// <summary>Peak magnitude since the last <see cref="Restart"/>.</summary>
        public float Peak(int channel = 0) => peaks[channel];

        public void Restart()
        {
            Array.Clear(peaks, 0, peaks.Length);
            blocks = 0;
            broken = 0;
        }

        private void OnAudioFilterRead(float[] data, int channels)
        {
            for (int index = 0; index < data.Length; ++index)
            {
                float size = Math.Abs(data[index]);
                if (!(size <= 1f))
                {
                    broken = broken + 1;
                }
                int channel = index % channels;
                peaks[channel] = Math.Max(peaks[channel], size);
            }
            blocks = blocks + 1;
        }
    }
}
