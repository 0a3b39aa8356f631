#nullable enable
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Plays a clip on one stylus or on all of them. Buttons and other events call
    /// <see cref="Play"/>. Main thread.</summary>
    [AddComponentMenu("HaptoFlow/Haptic Clip Player")]
    [HelpPage(HelpPages.Components + "haptic-clip-player")]
    public sealed class HapticClipPlayer : MonoBehaviour
    {
        [SerializeField, Tooltip("This clip is played: an imported .haptic, .ahap or .hjif file.")]
        private HapticClip? clip;

        [SerializeField, Tooltip("The clip plays on this stylus. When it is empty, it plays on the one on this object or " +
            "above it, and where there is none, on every stylus of the scene.")]
        private HapticStylus? stylus;

        [SerializeField, Range(0f, HapticClipFile.MaximumGain), Tooltip("The gain of the clip; 1 plays it as strongly " +
            "as its file says.")]
        private float gain = 1f;

        [SerializeField, Tooltip("When it is on, the clip repeats until this component is stopped or disabled.")]
        private bool loop;

        [SerializeField, Tooltip("When it is on, the clip plays as soon as this component is enabled and haptics are " +
            "ready.")]
        private bool playOnEnable;

        private HapticClip? started;
        private bool waits;

        /// <summary>The clip; null for none.</summary>
        public HapticClip? Clip { get => clip; set => clip = value; }

        /// <summary>The stylus; null for the one on this object or above it, else every stylus.</summary>
        public HapticStylus? Stylus { get => stylus; set => stylus = value; }

        /// <summary>Gain, 0 to <see cref="HapticClipFile.MaximumGain"/>, from the next <see cref="Play"/> on.</summary>
        public float Gain { get => gain; set => gain = HapticStylus.ClipGain(value); }

        /// <summary>True to repeat the clip, from the next <see cref="Play"/> on.</summary>
        public bool Loop { get => loop; set => loop = value; }

        /// <summary>True to play when the component is enabled.</summary>
        public bool PlayOnEnable { get => playOnEnable; set => playOnEnable = value; }

        /// <summary>Plays the clip from its beginning. Does nothing while haptics are not ready.</summary>
        public void Play()
        {
            waits = false;
            Begin();
        }

        /// <summary>Ends the clip, unless a stylus plays another one by now.</summary>
        public void Stop()
        {
            waits = false;
            if (started is null)
            {
                return;
            }
            IReadOnlyList<HapticStylus> styluses = HapticStylus.Enabled;
            for (int index = 0; index < styluses.Count; ++index)
            {
                styluses[index].StopClip(started);
            }
            started = null;
        }

        private void OnEnable()
        {
            waits = playOnEnable;
            // Reads the file now rather than at the first click.
            _ = clip != null ? clip.Content : null;
        }

        private void OnDisable()
        {
            waits = false;
            // A button may be gone before its click has ended, but nobody could end a loop any more.
            if (loop)
            {
                Stop();
            }
        }

        private void Update()
        {
            if (waits)
            {
                waits = !Begin();
            }
        }

        private bool Begin()
        {
            if (clip == null)
            {
                return false;
            }
            bool plays = false;
            HapticStylus? own = stylus != null ? stylus : GetComponentInParent<HapticStylus>(false);
            IReadOnlyList<HapticStylus> styluses = HapticStylus.Enabled;
            for (int index = 0; index < styluses.Count; ++index)
            {
                if (own == null || own == styluses[index])
                {
                    plays |= styluses[index].Play(clip, gain, loop);
                }
            }
            started = plays ? clip : started;
            return plays;
        }
    }
}
