#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Where the audio engine asks for samples: a component of its own, because some platforms no longer call a
    /// filter that was there before the audio device changed. A new one replaces it then, last among the filters of its
    /// object.</summary>
    [AddComponentMenu("")]
    internal sealed class AudioFilter : MonoBehaviour
    {
        private volatile Action<float[], int>? render;
        private AudioSource? source;
        private double endSeconds = double.PositiveInfinity;

        /// <summary>Adds a filter below the others of an object. Main thread.</summary>
        /// <param name="render">Called on the audio thread with interleaved samples and the number of channels.</param>
        public static AudioFilter AddTo(GameObject owner, Action<float[], int> render)
        {
            var filter = owner.AddComponent<AudioFilter>();
            filter.render = render;
            return filter;
        }

        /// <summary>Ends the calls when what still sounds has faded, and destroys the source's object. Main
        /// thread.</summary>
        public void RetireAfter(double seconds, AudioSource? last)
        {
            source = last;
            endSeconds = Time.unscaledTimeAsDouble + seconds;
        }

        /// <summary>Ends the calls at once: until the end of the frame a filter and its successor exist together. Main
        /// thread.</summary>
        public void Retire()
        {
            render = null;
            Destroy(this);
            if (source != null)
            {
                source.Stop();
                Destroy(source.gameObject);
            }
        }

        private void Update()
        {
            if (Time.unscaledTimeAsDouble >= endSeconds)
            {
                Retire();
            }
        }

        // Audio thread: no garbage, no locks.
        private void OnAudioFilterRead(float[] data, int channels) => render?.Invoke(data, channels);
    }
}
