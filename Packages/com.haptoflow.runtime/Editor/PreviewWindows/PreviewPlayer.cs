#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
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

        /// <summary>Stops, and forgets the device.</summary>
        public void Close()
        {
            Stop();
            felt.Close();
        }

        /// <inheritdoc/>
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
