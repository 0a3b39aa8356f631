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

    /// <summary>Plays the active sound of the Texture Preview, also on a device. Main thread.</summary>
    internal sealed class PreviewPlayer : SoundPlayer
    {
        private static readonly GUIContent Play = new GUIContent("Play", "Plays or stops. Key Space.");
        private static readonly GUIContent Stopping = new GUIContent("Stop", "Plays or stops. Key Space.");
        private static readonly GUIContent Loop =
            new GUIContent("Loop", "Repeats playback, with changes as soon as they are rendered.");
        private static readonly GUIContent Raise = new GUIContent("Normalise",
            "Plays both sounds with the gain at which the louder one nearly reaches full scale. Exported files are " +
            "not affected.");
        private static readonly GUIContent FeelOn = new GUIContent("Feel on",
            "The connected device that plays the waveform too, as strongly as a scene does by default. Controllers of a " +
            "headset are found in Play mode.");
        private static readonly string[] FeltNames = { "None", "Left hand", "Right hand", "Gamepad" };
        private static readonly GUIContent[] Sides =
        {
            new GUIContent("A", "Plays material A. Key A."), new GUIContent("B", "Plays material B. Key B."),
        };
        private static readonly GUIContent ExportButton =
            new GUIContent("Export\u2026",
                $"Writes a WAV file (48 kHz, 32-bit float; a sample of 1 is {PreviewSound.FullScaleMps2:0} m/s^2), or a clip " +
                "for the tools of Meta, Apple and MPEG-I. Ctrl or Cmd + E.");
        private static readonly GUIContent Measure =
            new GUIContent("Measure", "Times the tiers again on this machine.");

        private readonly TexturePreviewState state;
        private readonly PreviewSession session;
        private readonly FeltPlayback felt = new FeltPlayback();

        public PreviewPlayer(TexturePreviewState state, PreviewSession session) =>
            (this.state, this.session) = (state, session);

        // Where the editor cannot play clips, a device still can.
        public override bool IsPlaying => base.IsPlaying || (!Speaker.IsAvailable && felt.IsPlaying);

        public override float Gain => state.Raises && Peak > 0f ? Mathf.Max(1f, RaisedPeak / Peak) : 1f;

        protected override IReadOnlyList<AnalysedSound> Sounds => session.Shown?.Sounds ?? Array.Empty<AnalysedSound>();

        protected override int Index => state.PlayedIndex;

        protected override (bool Raises, bool Loops) Mode => (state.Raises, state.Loops);

        protected override bool IsFinal => session.IsFinal;

        protected override int PositionSamples => base.IsPlaying ? base.PositionSamples : felt.PositionSamples;

        public override void Stop()
        {
            base.Stop();
            felt.Stop();
        }

        public void Close()
        {
            Stop();
            felt.Close();
        }

        public override bool Step()
        {
            felt.Device = state.FeltOn;
            bool moved = base.Step();
            felt.Step(Speaker.IsPlaying ? Speaker.PositionSamples : (int?)null);
            return moved;
        }

        public void DrawButtons(Action export)
        {
            EditorGUILayout.Space(4f);
            using (new EditorGUILayout.HorizontalScope())
            {
                if (GUILayout.Button(IsPlaying ? Stopping : Play, GUILayout.Width(56f)))
                {
                    Toggle();
                }
                using (new EditorGUI.DisabledScope(!state.Compares && !state.ShowsDevice))
                {
                    state.Enter("Material", state.PlayedIndex,
                        GUILayout.Toolbar(state.PlayedIndex, Sides, GUILayout.Width(64f)),
                        (changed, side) => changed.Active = side);
                }
                if (GUILayout.Button(ExportButton))
                {
                    export();
                }
                state.Enter("Format", (int)state.ExportAs,
                    EditorGUILayout.Popup(
                        GUIContent.none, (int)state.ExportAs, SoundExport.Endings, GUILayout.Width(64f)),
                    (changed, format) => changed.ExportAs = (SoundFormat)format);
                if (GUILayout.Button(Measure))
                {
                    session.MeasureAgain();
                }
            }
            using (new EditorGUILayout.HorizontalScope())
            {
                DrawSwitch(Loop, state.Loops, (changed, value) => changed.Loops = value);
                DrawSwitch(Raise, state.Raises, (changed, value) => changed.Raises = value);
                GUILayout.Label(Remark(), EditorStyles.miniLabel);
            }
            DrawDevice();
            GUILayout.Label(PreviewKeys.Help, EditorStyles.wordWrappedMiniLabel);
        }

        private void DrawDevice()
        {
            using (new EditorGUILayout.HorizontalScope())
            {
                float before = EditorGUIUtility.labelWidth;
                EditorGUIUtility.labelWidth = 56f;
                state.Enter("Device", (int)state.FeltOn,
                    EditorGUILayout.Popup(FeelOn, (int)state.FeltOn, FeltNames, GUILayout.Width(148f)),
                    (changed, device) => changed.FeltOn = (FeltDevice)device);
                EditorGUIUtility.labelWidth = before;
                GUILayout.Label(felt.Remark, EditorStyles.miniLabel);
            }
        }

        private void DrawSwitch(GUIContent title, bool value, Action<TexturePreviewState, bool> change) =>
            state.Enter(title.text, value, GUILayout.Toggle(value, title, GUILayout.Width(84f)), change);

        private string Remark() => !Speaker.IsAvailable
            ? "this editor cannot play clips; export instead"
            : session.IsBusy
                ? "rendering\u2026"
                : Gain > 1f ? AxisNumbers.Text(20.0 * Math.Log10(Gain), 0, true) + " dB" : "";

        protected override void Start(AnalysedSound sound, int sample)
        {
            base.Start(sound, sample);
            // A simulated device's sound on a real device would be that of two devices.
            felt.Play(state.ShowsDevice ? Sounds[0].Sound : sound.Sound, sample, state.Loops);
        }
    }
}
