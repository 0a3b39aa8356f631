#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The text and the picture of a clip's Inspector.</summary>
    internal sealed class ClipSummary : FileSummary
    {
        private static readonly string[] Formats = { ".haptic (Meta, Lofelt)", ".ahap (Apple)", ".hjif (MPEG-I haptics)" };

        private ClipSummary(string problem) => Problem = problem;

        private ClipSummary(HapticClipFile clip)
        {
            Title = clip.Info.Title;
            Description = clip.Info.Description;
            Omitted = clip.Info.Omitted;
            SetRows(RowsOf(clip.Info));
            Curves = new ClipCurves(clip);
        }

        /// <summary>The vibration at <see cref="PreviewSound.RateHz"/>, in m/s^2.</summary>
        /// <exception cref="HaptoFlowException">The library is missing, or the file is damaged.</exception>
        public static float[] Wave(byte[] file)
        {
            using HapticClipFile clip = HapticClipFile.Read(file);
            return clip.Wave(PreviewSound.RateHz);
        }

        /// <summary>What the file has and is not played; empty for nothing.</summary>
        public string Omitted { get; } = "";

        /// <summary>Null where there is a problem.</summary>
        public ClipCurves? Curves { get; }

        public static ClipSummary Of(byte[] file)
        {
            try
            {
                using HapticClipFile clip = HapticClipFile.Read(file);
                return new ClipSummary(clip);
            }
            catch (HaptoFlowException refusal)
            {
                return new ClipSummary(FileProblem.Of(refusal, file).Text);
            }
        }

        private static IEnumerable<SummaryRow> RowsOf(HapticClipInfo info)
        {
            yield return new SummaryRow("Format", Formats[(int)info.Format]);
            yield return new SummaryRow("Duration", SummaryRow.Format("{0:0.###} s", info.DurationSeconds));
            yield return new SummaryRow("Points", SummaryRow.Format(
                "{0} of amplitude, {1} of frequency", info.AmplitudePoints, info.FrequencyPoints));
            yield return new SummaryRow("Transients", SummaryRow.Format("{0}", info.Transients));
            yield return new SummaryRow("Largest Amplitude",
                SummaryRow.Format("{0:0} % of a device's range", 100f * info.LargestAmplitude));
            yield return new SummaryRow("Made With", info.Editor);
        }
    }

    /// <summary>Draws the summary of a clip. Main thread, within OnInspectorGUI.</summary>
    internal sealed class ClipSummaryView
    {
        private static readonly GUIContent Play =
            new GUIContent("Play", "Plays the vibration on the speakers, as loudly as they go without distortion.");
        private static readonly GUIContent Stop = new GUIContent("Stop", "Ends the playback.");

        private readonly byte[] file;
        private readonly ClipSummary summary;
        private readonly EditorPicture picture;
        private readonly PreviewSpeaker speaker = new PreviewSpeaker();
        private PreviewView? view;
        private Box box;

        public ClipSummaryView(byte[] file)
        {
            this.file = file;
            summary = ClipSummary.Of(file);
            picture = new EditorPicture(canvas => ClipChart.Draw(canvas, view!.Palette, box, summary.Curves!));
        }

        public void Draw()
        {
            if (!summary.DrawHeading("clip"))
            {
                return;
            }
            DrawPicture(EditorGUILayout.GetControlRect(false, (float)ClipChart.Height));
            summary.DrawRows();
            using (new EditorGUI.DisabledScope(!speaker.IsAvailable))
            {
                if (GUILayout.Button(speaker.IsAvailable && speaker.IsPlaying ? Stop : Play))
                {
                    Toggle();
                }
            }
            if (summary.Omitted.Length > 0)
            {
                EditorGUILayout.HelpBox("Not played: " + summary.Omitted + ".", MessageType.Info);
            }
        }

        public void Release()
        {
            speaker.Stop();
            picture.Release();
        }

        private void Toggle()
        {
            if (speaker.IsPlaying)
            {
                speaker.Stop();
                return;
            }
            float[] wave = ClipSummary.Wave(file);
            float peak = wave.Select(sample => Mathf.Abs(sample)).DefaultIfEmpty().Max();
            if (peak > 0f)
            {
                speaker.Play(wave, SoundPlayer.RaisedPeak / peak, 0, false);
            }
        }

        private void DrawPicture(Rect area)
        {
            if (Event.current.type != EventType.Repaint)
            {
                return;
            }
            view = PreviewView.Of(area, PreviewRoom.Default, view);
            box = new Box(0.0, 0.0, area.width, area.height);
            // The picture stays where it is in its own coordinates while the Inspector scrolls.
            GUI.BeginClip(area, Vector2.zero, Vector2.zero, false);
            picture.OnGUI(summary, view);
            GUI.EndClip();
        }
    }

    [CustomEditor(typeof(HapticClipImporter))]
    internal sealed class HapticClipImporterEditor : FileInspector
    {
        private ClipSummaryView? view;

        public override void OnEnable()
        {
            base.OnEnable();
            view = assetTarget is HapticClip clip ? new ClipSummaryView(clip.File) : null;
        }

        public override void OnDisable()
        {
            view?.Release();
            base.OnDisable();
        }

        public override void OnInspectorGUI()
        {
            if (view == null)
            {
                DrawNotImported();
                return;
            }
            view.Draw();
        }
    }

    /// <summary>The Inspector of a clip that has no file of its own.</summary>
    [CustomEditor(typeof(HapticClip))]
    internal sealed class HapticClipEditor : UnityEditor.Editor
    {
        private ClipSummaryView? view;

        private void OnDisable() => view?.Release();

        public override void OnInspectorGUI()
        {
            view ??= new ClipSummaryView(((HapticClip)target).File);
            view.Draw();
        }
    }
}
