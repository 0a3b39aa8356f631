#nullable enable
using System;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow
{
    /// <summary>The calls that an output gets from the audio engine: from a source on a child object of its own, which
    /// leaves the author's sources alone, or from the Audio Listener on the output's object. Main thread.</summary>
    internal sealed class AudioCalls
    {
        private readonly Action<float[], int> render;
        // Two blocks of the longest device, the first of which may have begun, and the fade.
        private const double FadeSeconds = 0.4;

        private AudioFilter? filter;
        private AudioFilter? fading;
        private AudioSource? source;

        /// <param name="render">Called on the audio thread with interleaved samples and the number of channels.</param>
        public AudioCalls(Action<float[], int> render) => this.render = render;

        /// <summary>Has everything that the engine calls made anew. Not during OnEnable: Unity then refuses to change the
        /// hierarchy.</summary>
        public void Open(GameObject owner, OutputRoute route, bool obeysVolume)
        {
            Close();
            if (route == OutputRoute.ListenerChannel)
            {
                filter = AudioFilter.AddTo(owner, render);
            }
            else if (route == OutputRoute.AudioSource)
            {
                source = MakeSource(owner);
                filter = AudioFilter.AddTo(source.gameObject, render);
                ObeyVolume(obeysVolume);
                source.Play();
            }
        }

        /// <summary>Lets what sounds fade, and then closes.</summary>
        public void CloseAfterTheFade()
        {
            fading = filter;
            if (fading != null)
            {
                fading.RetireAfter(FadeSeconds, source);
            }
            filter = null;
            source = null;
        }

        public void Close()
        {
            if (fading != null)
            {
                fading.Retire();
            }
            fading = null;
            if (filter != null)
            {
                filter.Retire();
            }
            if (source != null)
            {
                source.Stop();
                Object.Destroy(source.gameObject);
            }
            filter = null;
            source = null;
        }

        /// <summary>Whether AudioListener.volume applies to the source.</summary>
        public void ObeyVolume(bool obeys)
        {
            if (source != null)
            {
                source.ignoreListenerVolume = !obeys;
            }
        }

        private static AudioSource MakeSource(GameObject owner)
        {
            var child = new GameObject("HaptoFlow Source");
            child.transform.SetParent(owner.transform, false);
            var made = child.AddComponent<AudioSource>();
            made.playOnAwake = false;
            made.spatialBlend = 0f;
            made.priority = 0;
            made.dopplerLevel = 0f;
            made.bypassReverbZones = true;
            made.bypassListenerEffects = true;
            // The output pauses its voices, which fade out; a paused source would cut them off.
            made.ignoreListenerPause = true;
            return made;
        }
    }
}
