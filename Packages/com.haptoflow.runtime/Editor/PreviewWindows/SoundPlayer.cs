#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Plays the chosen one of the sounds of a window, and continues with its replacement at the same
    /// position. Main thread.</summary>
    internal abstract class SoundPlayer
    {
        /// <summary>Peak of the louder sound after normalising.</summary>
        public const float RaisedPeak = 0.9f;

        private AnalysedSound? playing;
        private (bool Raises, bool Loops) mode;
        private bool waits;
        private bool wasPlaying;

        public AnalysedSound? PlayedSound => Index < Sounds.Count ? Sounds[Index] : null;

        public virtual bool IsPlaying => Speaker.IsPlaying;

        /// <summary>Position of playback; null while nothing plays.</summary>
        public double? PlayedSeconds => IsPlaying ? PositionSamples / (double)PreviewSound.RateHz : (double?)null;

        public abstract float Gain { get; }
        protected PreviewSpeaker Speaker { get; } = new PreviewSpeaker();

        /// <summary>The sounds that are shown; none until they are rendered.</summary>
        protected abstract IReadOnlyList<AnalysedSound> Sounds { get; }

        protected abstract int Index { get; }

        /// <summary>Whether playback is normalised, and whether it is repeated.</summary>
        protected abstract (bool Raises, bool Loops) Mode { get; }

        /// <summary>True if the sounds belong to the present settings.</summary>
        protected abstract bool IsFinal { get; }

        protected virtual int PositionSamples => Speaker.PositionSamples;

        protected float Peak => Sounds.Select(each => each.Sound.Peak).DefaultIfEmpty().Max();

        /// <summary>Plays from the beginning, or stops.</summary>
        public void Toggle()
        {
            if (IsPlaying)
            {
                Stop();
            }
            else
            {
                PlayWhenReady();
            }
        }

        /// <summary>Plays as soon as the present settings are rendered.</summary>
        public void PlayWhenReady() => waits = true;

        public virtual void Stop()
        {
            waits = false;
            playing = null;
            Speaker.Stop();
        }

        /// <summary>Call this at each editor update.</summary>
        /// <returns>True if the window must be drawn again.</returns>
        public virtual bool Step()
        {
            AnalysedSound? sound = IsFinal ? PlayedSound : null;
            if (waits && sound != null)
            {
                waits = false;
                Start(sound, 0);
            }
            else if (IsPlaying && sound != null && (!ReferenceEquals(sound, playing) || mode != Mode))
            {
                Start(sound, PositionSamples);
            }
            else if (playing != null && !IsPlaying)
            {
                Stop();
            }
            bool moved = wasPlaying || IsPlaying;
            wasPlaying = IsPlaying;
            return moved;
        }

        protected virtual void Start(AnalysedSound sound, int sample)
        {
            playing = sound;
            mode = Mode;
            Speaker.Play(sound.Sound.Samples, Gain, sample, mode.Loops);
        }
    }

    /// <summary>Plays sounds in edit mode and without an AudioListener, as the Inspector of an AudioClip does. Unity's
    /// class for this, UnityEditor.AudioUtil, is internal, so that it is called by reflection; its methods are the same
    /// in 2022.3 and 6000.0. Main thread.</summary>
    internal sealed class PreviewSpeaker
    {
        private const BindingFlags Any = BindingFlags.Static | BindingFlags.Public | BindingFlags.NonPublic;

        private readonly MethodInfo? play;
        private readonly MethodInfo? stop;
        private readonly MethodInfo? isPlaying;
        private readonly MethodInfo? position;
        private AudioClip? clip;

        public PreviewSpeaker()
        {
            Type? player = typeof(EditorWindow).Assembly.GetType("UnityEditor.AudioUtil");
            play = Find(player, "PlayPreviewClip", typeof(void), typeof(AudioClip), typeof(int), typeof(bool));
            stop = Find(player, "StopAllPreviewClips", typeof(void));
            isPlaying = Find(player, "IsPreviewClipPlaying", typeof(bool));
            position = Find(player, "GetPreviewClipSamplePosition", typeof(int));
        }

        public bool IsAvailable => play != null && stop != null && isPlaying != null && position != null;

        /// <summary>True while the sound that was started last plays.</summary>
        public bool IsPlaying => clip != null && (bool)isPlaying!.Invoke(null, null);

        /// <summary>Position of playback; 0 while nothing plays.</summary>
        public int PositionSamples => IsPlaying ? (int)position!.Invoke(null, null) : 0;

        /// <summary>Plays samples in place of the present ones.</summary>
        /// <param name="sound">At <see cref="PreviewSound.RateHz"/>, one channel.</param>
        /// <param name="gain">The products are limited to -1 to 1.</param>
        /// <param name="startSample">Start position; a position past the end counts as 0.</param>
        public void Play(float[] sound, float gain, int startSample, bool loops)
        {
            Stop();
            if (!IsAvailable)
            {
                return;
            }
            float[] samples = Array.ConvertAll(sound, sample => Mathf.Clamp(gain * sample, -1f, 1f));
            clip = AudioClip.Create("HaptoFlow Preview", samples.Length, 1, PreviewSound.RateHz, false);
            clip.hideFlags = HideFlags.HideAndDontSave;
            clip.SetData(samples, 0);
            play!.Invoke(null, new object[] { clip, startSample < samples.Length ? startSample : 0, loops });
        }

        /// <summary>Stops playback and destroys the clip.</summary>
        public void Stop()
        {
            if (clip == null)
            {
                return;
            }
            stop!.Invoke(null, null);
            Object.DestroyImmediate(clip);
            clip = null;
        }

        private static MethodInfo? Find(Type? player, string name, Type result, params Type[] parameters)
        {
            MethodInfo? method = player?.GetMethod(name, Any, null, parameters, null);
            return method?.ReturnType == result ? method : null;
        }
    }

    /// <summary>Plays the recording or the result of the New Material window. Main thread.</summary>
    internal sealed class NewMaterialPlayer : SoundPlayer
    {
        private readonly NewMaterialState state;
        private readonly NewMaterialSession session;

        public NewMaterialPlayer(NewMaterialState state, NewMaterialSession session) =>
            (this.state, this.session) = (state, session);

        public bool IsAvailable => Speaker.IsAvailable;

        /// <summary>Gain of both sounds, at which the louder one nearly reaches full scale.</summary>
        public override float Gain => RaisedPeak / Mathf.Max(1e-6f, Peak);

        protected override IReadOnlyList<AnalysedSound> Sounds => session.Shown?.Sounds ?? Array.Empty<AnalysedSound>();

        protected override int Index => Math.Min(state.Active, Math.Max(0, Sounds.Count - 1));

        protected override (bool Raises, bool Loops) Mode => (true, state.Loops);

        protected override bool IsFinal => !session.IsBusy;
    }
}
