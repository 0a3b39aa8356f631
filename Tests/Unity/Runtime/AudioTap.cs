#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.Tests
{
    /// <summary>Records what an output on its object plays: behind the newest filter of the output, on whichever object
    /// that is. Without an output, and on an Audio Listener, what the filters of its own object play.</summary>
    internal sealed class AudioTap : MonoBehaviour
    {
        private const int MostChannels = 8;
        private readonly float[] peaks = new float[MostChannels];
        private AudioFilter? tapped;
        private TapFilter? filter;
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

        internal void Record(float[] data, int channels)
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

        private void LateUpdate()
        {
            bool ofOutput = TryGetComponent(out HapticOutput output) && output.Route == OutputRoute.AudioSource &&
                !TryGetComponent(out AudioListener _);
            AudioFilter? found = ofOutput ? FilterOfSource() : null;
            GameObject owner = found != null ? found.gameObject : gameObject;
            if (!ofOutput && TryGetComponent(out AudioFilter last))
            {
                found = last;
            }
            if (filter == null || !ReferenceEquals(found, tapped))
            {
                if (filter != null)
                {
                    filter.Tap = null;
                    Destroy(filter);
                }
                tapped = found;
                filter = owner.AddComponent<TapFilter>();
                filter.Tap = this;
            }
        }

        private AudioFilter? FilterOfSource()
        {
            for (int child = 0; child < transform.childCount; ++child)
            {
                if (transform.GetChild(child).TryGetComponent(out AudioFilter found))
                {
                    return found;
                }
            }
            return null;
        }
    }

    internal sealed class TapFilter : MonoBehaviour
    {
        internal AudioTap? Tap { get; set; }

        private void OnAudioFilterRead(float[] data, int channels) => Tap?.Record(data, channels);
    }

    /// <summary>Steps the engine once after every frame in place of the worker, so that results do not depend on the
    /// machine.</summary>
    [DefaultExecutionOrder(2000)]
    internal sealed class EngineStepper : MonoBehaviour
    {
        private void LateUpdate() => HapticSession.Existing?.Engine?.Step();
    }

    /// <summary>A constant signal on every channel, in place of other sources.</summary>
    internal sealed class SteadySource : MonoBehaviour
    {
        private void OnAudioFilterRead(float[] data, int channels)
        {
            for (int index = 0; index < data.Length; ++index)
            {
                data[index] = 0.25f;
            }
        }
    }
}
