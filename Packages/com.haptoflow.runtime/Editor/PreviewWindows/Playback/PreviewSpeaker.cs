#nullable enable
using System;
using System.Reflection;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
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

        /// <summary>True if this editor has the methods.</summary>
        public bool IsAvailable => play != null && stop != null && isPlaying != null && position != null;

        /// <summary>True while the sound that was started last plays.</summary>
        public bool IsPlaying => clip != null && (bool)isPlaying!.Invoke(null, null);

        /// <summary>Position of playback; 0 while nothing plays.</summary>
        public int PositionSamples => IsPlaying ? (int)position!.Invoke(null, null) : 0;

        /// <summary>Plays a sound in place of the present one.</summary>
        /// <param name="gain">The products are limited to -1 to 1.</param>
        /// <param name="startSample">Start position; a position past the end counts as 0.</param>
        public void Play(PreviewSound sound, float gain, int startSample, bool loops)
        {
            Stop();
            if (!IsAvailable)
            {
                return;
            }
            var samples = new float[sound.Samples.Length];
            for (int index = 0; index < samples.Length; ++index)
            {
                samples[index] = Mathf.Clamp(gain * sound.Samples[index], -1f, 1f);
            }
            clip = AudioClip.Create("HaptoFlow Texture Preview", samples.Length, 1, PreviewSound.RateHz, false);
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
}
