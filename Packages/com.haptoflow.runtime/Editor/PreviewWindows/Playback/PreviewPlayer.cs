#nullable enable
using System;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Plays what is shown, and goes on with what takes its place. Main thread.</summary>
    internal sealed class PreviewPlayer
    {
        /// <summary>The louder of the materials is raised to this; the other one by as much.</summary>
        public const float RaisedPeak = 0.9f;

        private static readonly GUIContent Play = new GUIContent("Play", "Space plays and stops.");
        private static readonly GUIContent Stopping = new GUIContent("Stop", "Space plays and stops.");
        private static readonly GUIContent Loop =
            new GUIContent("Loop", "Begins again at the end. Changes are heard while it plays.");
        private static readonly GUIContent Raise = new GUIContent("Louder",
            "Raises both materials by as much, until the louder one fills the speakers' range. What is exported " +
            "stays as it is.");
        private static readonly GUIContent[] Sides =
        {
            new GUIContent("A", "Hear material A. Key A."), new GUIContent("B", "Hear material B. Key B."),
        };
        private static readonly GUIContent ExportButton =
            new GUIContent("Export WAV\u2026",
                $"48 kHz, 32-bit float; +-1 is {PreviewSound.FullScaleMps2:0} m/s^2. Ctrl or Cmd + E.");
        private static readonly GUIContent Measure =
            new GUIContent("Measure", "Measures the milliseconds of the table again, on this machine.");

        private readonly TexturePreviewState state;
        private readonly PreviewSession session;
        private readonly PreviewSpeaker speaker = new PreviewSpeaker();
        private AnalysedSound? playing;
        private bool raised;
        private bool looped;
        private bool waits;
        private bool wasPlaying;

        public PreviewPlayer(TexturePreviewState state, PreviewSession session)
        {
            this.state = state;
            this.session = session;
        }

        /// <summary>The active material's; null where nothing was rendered.</summary>
        public AnalysedSound? PlayedSound =>
            session.Shown != null && state.PlayedIndex < session.Shown.Sounds.Count
                ? session.Shown.Sounds[state.PlayedIndex]
                : null;

        /// <summary>Where the playhead is; null while nothing plays.</summary>
        public double? PlayedSeconds =>
            speaker.IsPlaying ? speaker.PositionSamples / (double)PreviewSound.RateHz : (double?)null;

        public bool IsPlaying => speaker.IsPlaying;

        /// <summary>What is multiplied into the samples for the speakers.</summary>
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
            if (speaker.IsPlaying)
            {
                Stop();
            }
            else
            {
                PlayWhenReady();
            }
        }

        /// <summary>Plays as soon as what is set is rendered.</summary>
        public void PlayWhenReady() => waits = true;

        public void Stop()
        {
            waits = false;
            playing = null;
            speaker.Stop();
        }

        /// <summary>Once an editor update.</summary>
        /// <returns>Something moves: the window is to be drawn again.</returns>
        public bool Step()
        {
            if (waits && session.IsFinal && PlayedSound != null)
            {
                waits = false;
                Start(0);
            }
            else if (speaker.IsPlaying && session.IsFinal && PlayedSound != null && IsOther())
            {
                Start(speaker.PositionSamples);
            }
            else if (playing != null && !speaker.IsPlaying)
            {
                Stop();
            }
            bool moved = wasPlaying || speaker.IsPlaying;
            wasPlaying = speaker.IsPlaying;
            return moved;
        }

        public void DrawButtons(Action export)
        {
            EditorGUILayout.Space(4f);
            using (new EditorGUILayout.HorizontalScope())
            {
                if (GUILayout.Button(speaker.IsPlaying ? Stopping : Play, GUILayout.Width(56f)))
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
            GUILayout.Label(PreviewKeys.Help, EditorStyles.wordWrappedMiniLabel);
        }

        private void DrawSwitch(GUIContent title, bool value, Action<TexturePreviewState, bool> change)
        {
            bool entered = GUILayout.Toggle(value, title, GUILayout.Width(64f));
            if (entered != value)
            {
                state.Change(title.text, changed => change(changed, entered));
            }
        }

        private string Remark() => !speaker.IsAvailable
            ? "this editor plays no clips: export instead"
            : session.IsBusy
                ? "rendering\u2026"
                : Gain > 1f ? AxisNumbers.Text(20.0 * Math.Log10(Gain), 0, true) + " dB" : "";

        private bool IsOther() =>
            !ReferenceEquals(PlayedSound, playing) || raised != state.Raises || looped != state.Loops;

        private void Start(int sample)
        {
            playing = PlayedSound;
            raised = state.Raises;
            looped = state.Loops;
            speaker.Play(playing!.Sound, Gain, sample, looped);
        }
    }
}
