#nullable enable
using System;
using System.Reflection;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Plays to the speakers through what the Inspector of an AudioClip plays through: outside of play mode
    /// too, and without a scene's listener. Unity keeps that to itself (UnityEditor.AudioUtil, the same in 2022.3 and
    /// 6000.0), so it is looked up by name. Main thread.</summary>
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

        /// <summary>Whether this editor lets clips be played.</summary>
        public bool IsAvailable => play != null && stop != null && isPlaying != null && position != null;

        /// <summary>What this speaker was given last still sounds.</summary>
        public bool IsPlaying => clip != null && (bool)isPlaying!.Invoke(null, null);

        /// <summary>Of what sounds.</summary>
        public int PositionSamples => IsPlaying ? (int)position!.Invoke(null, null) : 0;

        /// <summary>In the place of what sounds.</summary>
        /// <param name="gain">Samples are held within +-1 behind it.</param>
        /// <param name="startSample">Where to begin; beyond the end, at the beginning.</param>
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

        /// <summary>Silence, and no clip left behind.</summary>
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
