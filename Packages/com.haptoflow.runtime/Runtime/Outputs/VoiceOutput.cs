#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>What every output has: gain, mute and pause of the voices that it plays. Main thread.</summary>
    public abstract class VoiceOutput : MonoBehaviour
    {
        [SerializeField, Range(0f, 1f), Tooltip("The gain of this output, multiplied with the surface's and the " +
            "stylus's.")]
        private float strength = 1f;

        [SerializeField, Tooltip("A muted output is silent and costs no inference.")]
        private bool muted;

        [SerializeField, Tooltip("The output goes on while AudioListener.pause is on, as pause menus set it. When it is " +
            "off, it is silent meanwhile.")]
        private bool playWhilePaused;

        private bool isApplicationPaused;
        private bool isPaused;

        /// <summary>Gain, 0 to 1.</summary>
        public float Strength { get => strength; set => strength = Mathf.Clamp01(value); }

        /// <summary>A muted output is silent from this frame on and costs no inference.</summary>
        public bool Muted
        {
            get => muted;
            set
            {
                muted = value;
                ForEachVoice((voice, on) => voice.SetMuted(on), muted);
                Silence(muted);
            }
        }

        /// <summary>True to go on while AudioListener.pause is on, as a sound with AudioSource.ignoreListenerPause does.
        /// Off by default: a pause menu silences the output.</summary>
        public bool PlayWhilePaused { get => playWhilePaused; set => playWhilePaused = value; }

        /// <summary>Silences the output at once; each stylus sounds again with its next touch-down.</summary>
        public void Panic()
        {
            ForEachVoice((voice, _) => voice.Panic(), 0);
            Silence(true);
        }

        /// <summary>True while the application is paused, and while AudioListener.pause is set, unless the output plays
        /// while paused.</summary>
        private protected bool IsPaused => isPaused;

        internal abstract void ForEachVoice<T>(Action<HapticVoice, T> act, T argument);

        /// <summary>Called after the voices fell silent, or sound again.</summary>
        private protected virtual void Silence(bool isSilent)
        {
        }

        /// <summary>Sets up a voice as the output is now.</summary>
        private protected void Adopt(HapticVoice voice)
        {
            voice.SetMuted(muted);
            voice.SetPaused(isPaused);
        }

        /// <summary>Reads AudioListener.pause, which Unity does not report; true where the pause began or ended.</summary>
        private protected bool ReadPause()
        {
            bool before = isPaused;
            isPaused = isApplicationPaused || (AudioListener.pause && !playWhilePaused);
            return isPaused != before;
        }

        /// <summary>Pauses the voices, or lets them go on, where the output's pause began or ended.</summary>
        private protected void FollowPause()
        {
            if (ReadPause())
            {
                ForEachVoice((voice, on) => voice.SetPaused(on), isPaused);
                Silence(isPaused);
            }
        }

        private void OnApplicationPause(bool paused)
        {
            isApplicationPaused = paused;
            FollowPause();
        }
    }
}
