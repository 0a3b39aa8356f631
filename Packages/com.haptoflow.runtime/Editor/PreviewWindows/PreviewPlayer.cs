#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
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
            new GUIContent("Export WAV\u2026",
                $"48 kHz, 32-bit float; a sample of 1 is {PreviewSound.FullScaleMps2:0} m/s^2. Ctrl or Cmd + E.");
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

    /// <summary>Writes sounds to WAV files.</summary>
    internal static class WaveExport
    {
        /// <summary>A proposed file name, for example "wood 0.12 mps 1.5 N".</summary>
        public static string FileName(LabelMix material, StrokeSettings settings)
        {
            string name = string.Format(CultureInfo.InvariantCulture, "{0} {1:0.###} mps {2:0.##} N", material.Title,
                settings.SpeedMps, settings.ForceNewtons);
            return string.Concat(name.Select(letter => Path.GetInvalidFileNameChars().Contains(letter) ? '-' : letter));
        }

        /// <summary>Writes the samples as rendered, without the gain of playback: 48 kHz, 32-bit float, one channel, in
        /// units of <see cref="PreviewSound.FullScaleMps2"/>.</summary>
        /// <returns>An error message; null on success.</returns>
        public static string? Write(string path, PreviewSound sound)
        {
            try
            {
                File.WriteAllBytes(path, WaveFile.Bytes(sound.Samples, PreviewSound.RateHz));
                return null;
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                return error.Message;
            }
        }
    }

    /// <summary>Writes RIFF WAVE files with one channel of 32-bit floats, as the command line does: format tag 3, with
    /// the fact chunk that formats other than PCM need.</summary>
    /// <remarks>Unity reads WAV files and does not write them.</remarks>
    internal static class WaveFile
    {
        private const int HeaderBytes = 12 + 8 + 18 + 8 + 4 + 8;
        private const short FloatFormat = 3;

        /// <summary>The bytes of a file.</summary>
        /// <param name="samples">-1 to 1.</param>
        public static byte[] Bytes(ReadOnlySpan<float> samples, int rateHz)
        {
            int dataBytes = checked(samples.Length * sizeof(float));
            var file = new MemoryStream(checked(HeaderBytes + dataBytes));
            using var writer = new BinaryWriter(file, Encoding.ASCII);
            writer.Write("RIFF".ToCharArray());
            writer.Write(HeaderBytes + dataBytes - 8);
            writer.Write("WAVEfmt ".ToCharArray());
            writer.Write(18);
            writer.Write(FloatFormat);
            writer.Write((short)1);
            writer.Write(rateHz);
            writer.Write(rateHz * sizeof(float));
            writer.Write((short)sizeof(float));
            writer.Write((short)(8 * sizeof(float)));
            writer.Write((short)0);
            writer.Write("fact".ToCharArray());
            writer.Write(4);
            writer.Write(samples.Length);
            writer.Write("data".ToCharArray());
            writer.Write(dataBytes);
            foreach (float sample in samples)
            {
                writer.Write(sample);
            }
            return file.ToArray();
        }
    }
}
