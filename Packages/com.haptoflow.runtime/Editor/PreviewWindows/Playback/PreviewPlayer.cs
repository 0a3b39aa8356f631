#nullable enable
using System;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Plays the active sound, and continues with its replacement at the same position. Main thread.</summary>
    internal sealed class PreviewPlayer
    {
        /// <summary>Peak of the louder sound after normalising.</summary>
        public const float RaisedPeak = 0.9f;

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
            new GUIContent("Export WAV\u2026",
                $"48 kHz, 32-bit float; a sample of 1 is {PreviewSound.FullScaleMps2:0} m/s^2. Ctrl or Cmd + E.");
        private static readonly GUIContent Measure =
            new GUIContent("Measure", "Times the tiers again on this machine.");

        private readonly TexturePreviewState state;
        private readonly PreviewSession session;
        private readonly PreviewSpeaker speaker = new PreviewSpeaker();
        private readonly FeltPlayback felt = new FeltPlayback();
        private AnalysedSound? playing;
        private bool raised;
        private bool looped;
        private bool waits;
        private bool wasPlaying;

        public PreviewPlayer(TexturePreviewState state, PreviewSession session) =>
            (this.state, this.session) = (state, session);

        /// <summary>The active sound; null if nothing was rendered.</summary>
        public AnalysedSound? PlayedSound =>
            session.Shown != null && state.PlayedIndex < session.Shown.Sounds.Count
                ? session.Shown.Sounds[state.PlayedIndex]
                : null;

        /// <summary>Position of playback; null while nothing plays.</summary>
        public double? PlayedSeconds => IsPlaying ? PositionSamples / (double)PreviewSound.RateHz : (double?)null;

        // Where the editor cannot play clips, a device still can.
        public bool IsPlaying => speaker.IsPlaying || (!speaker.IsAvailable && felt.IsPlaying);

        /// <summary>Gain of playback.</summary>
        public float Gain
        {
            get
            {
                float peak = 0f;
                if (session.Shown != null)
                {
                    foreach (AnalysedSound sound in session.Shown.Sounds)
                    {
                        peak = Mathf.Max(peak, sound.Sound.Peak);
                    }
                }
                return state.Raises && peak > 0f ? Mathf.Max(1f, RaisedPeak / peak) : 1f;
            }
        }

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

        public void Stop()
        {
            waits = false;
            playing = null;
            speaker.Stop();
            felt.Stop();
        }

        /// <summary>Stops, and forgets the device.</summary>
        public void Close()
        {
            Stop();
            felt.Close();
        }

        /// <summary>Call this at each editor update.</summary>
        /// <returns>True if the window must be drawn again.</returns>
        public bool Step()
        {
            felt.Device = state.FeltOn;
            if (waits && session.IsFinal && PlayedSound != null)
            {
                waits = false;
                Start(0);
            }
            else if (IsPlaying && session.IsFinal && PlayedSound != null && IsOther())
            {
                Start(PositionSamples);
            }
            else if (playing != null && !IsPlaying)
            {
                Stop();
            }
            felt.Step(speaker.IsPlaying ? speaker.PositionSamples : (int?)null);
            bool moved = wasPlaying || IsPlaying;
            wasPlaying = IsPlaying;
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
                    int side = GUILayout.Toolbar(state.PlayedIndex, Sides, GUILayout.Width(64f));
                    if (side != state.PlayedIndex)
                    {
                        state.Change("Material", changed => changed.Active = side);
                    }
                }
                if (GUILayout.Button(ExportButton))
                {
                    export();
                }
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
                int entered = EditorGUILayout.Popup(FeelOn, (int)state.FeltOn, FeltNames, GUILayout.Width(148f));
                EditorGUIUtility.labelWidth = before;
                if (entered != (int)state.FeltOn)
                {
                    state.Change("Device", changed => changed.FeltOn = (FeltDevice)entered);
                }
                GUILayout.Label(felt.Remark, EditorStyles.miniLabel);
            }
        }

        private void DrawSwitch(GUIContent title, bool value, Action<TexturePreviewState, bool> change)
        {
            bool entered = GUILayout.Toggle(value, title, GUILayout.Width(84f));
            if (entered != value)
            {
                state.Change(title.text, changed => change(changed, entered));
            }
        }

        private string Remark() => !speaker.IsAvailable
            ? "this editor cannot play clips; export instead"
            : session.IsBusy
                ? "rendering\u2026"
                : Gain > 1f ? AxisNumbers.Text(20.0 * Math.Log10(Gain), 0, true) + " dB" : "";

        private int PositionSamples => speaker.IsPlaying ? speaker.PositionSamples : felt.PositionSamples;

        private bool IsOther() =>
            !ReferenceEquals(PlayedSound, playing) || raised != state.Raises || looped != state.Loops;

        private void Start(int sample)
        {
            playing = PlayedSound;
            raised = state.Raises;
            looped = state.Loops;
            speaker.Play(playing!.Sound, Gain, sample, looped);
            // A simulated device's sound on a real device would be that of two devices.
            felt.Play(state.ShowsDevice ? session.Shown!.Sounds[0].Sound : playing.Sound, sample, looped);
        }
    }
}
