#nullable enable
using System;
using System.Globalization;
using System.IO;
using System.Linq;
using HaptoFlow.Preview;
using HaptoFlow.Recordings;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The controls of the New Material window. Main thread, within OnGUI.</summary>
    internal sealed class NewMaterialControls
    {
        private const float LabelWidth = 112f;
        private const float ButtonWidth = 84f;

        private static readonly GUIContent Model =
            new GUIContent("Model", "The model that the material is learnt for. None: the project's model.");
        private static readonly GUIContent Choose = new GUIContent("Choose Recording\u2026",
            "A CSV table or a WAV file of one material, ten seconds or more. The file NAME.json beside it is read " +
            "too.");
        private static readonly GUIContent Speed = new GUIContent("Speed [m/s]",
            "Used if the file has none. 0: unknown.");
        private static readonly GUIContent Force = new GUIContent("Force [N]",
            "Used if the file has none. 0: unknown.");
        private static readonly GUIContent FullScale = new GUIContent("Full Scale [m/s\u00b2]",
            "Acceleration of a sample of 1 in the WAV file. Used if no sidecar file states it. 0: unknown.");
        private static readonly GUIContent Name = new GUIContent("Name", "Name of the material.");
        private static readonly GUIContent Category =
            new GUIContent("Category", "For example cloth or wood. Empty: the category of the start label.");
        private static readonly GUIContent Licence = new GUIContent("Licence",
            "Licence of the recording, stored in the material. Empty: unknown.");
        private static readonly GUIContent Description =
            new GUIContent("Description", "One or two sentences; may be empty.");
        private static readonly GUIContent LearnButton = new GUIContent("Learn",
            "Learns the material in the background, which takes ten to twenty seconds.");
        private static readonly GUIContent CancelButton =
            new GUIContent("Cancel", "Stops learning. An earlier result is kept.");
        private static readonly GUIContent Play = new GUIContent("Play", "Plays the chosen sound.");
        private static readonly GUIContent Stop = new GUIContent("Stop", "Stops playback.");
        private static readonly GUIContent[] Sides =
        {
            new GUIContent("Recording", "Plays the recording."),
            new GUIContent("Result", "Plays the learnt material with the motion of the recording."),
        };
        private static readonly GUIContent[] Views =
        {
            new GUIContent("Sounds", "Shows waveform and spectrogram of the recording and of the result."),
            new GUIContent("Curves",
                "Shows spectra, levels, kurtosis and ribs of recording, result and nearest label, and what was not " +
                "recorded."),
        };
        private static readonly GUIContent Loop = new GUIContent("Loop", "Repeats playback.");
        private static readonly GUIContent Match = new GUIContent("Match Levels",
            "Shows and plays the result at the recording's level, so that only the textures differ.");
        private static readonly GUIContent SaveButton = new GUIContent("Save as Haptic Material\u2026",
            "Saves the material as an asset. The model does not change.");
        private static readonly GUIContent ExportButton = new GUIContent("Export File\u2026",
            "Writes a .haptomaterial file, for the command line and other projects.");

        private readonly NewMaterialState state;

        // Copies from the last layout event: IMGUI needs the same controls in the events that follow it.
        private bool learns;
        private bool hasResult;
        private bool hasCurves;
        private string obstacle = "";
        private string problem = "";
        private string found = "";
        private string report = "";

        public NewMaterialControls(NewMaterialState state) => this.state = state;

        /// <summary>Raised by the button of the same name. Handlers must open dialogs after the event.</summary>
        public event Action? ChoosePressed;

        public event Action? LearnPressed;

        public event Action? SavePressed;

        public event Action? ExportPressed;

        /// <param name="model">The model in use; null for none.</param>
        public void Draw(NewMaterialSession session, NewMaterialPlayer player, HapticModelAsset? model)
        {
            if (Event.current.type == EventType.Layout)
            {
                LayOut(session, model);
            }
            float before = EditorGUIUtility.labelWidth;
            EditorGUIUtility.labelWidth = LabelWidth;
            state.DrawModel(Model);
            if (GUILayout.Button(Choose))
            {
                ChoosePressed?.Invoke();
            }
            if (found.Length > 0)
            {
                EditorGUILayout.HelpBox(found, MessageType.None);
            }
            DrawMotion(session.FromFile);
            EditorGUILayout.Space(4f);
            DrawText(Name, state.Name, (changed, text) => changed.Name = text);
            DrawText(Category, state.Category, (changed, text) => changed.Category = text);
            DrawText(Licence, state.Licence, (changed, text) => changed.Licence = text);
            DrawText(Description, state.Description, (changed, text) => changed.Description = text);
            EditorGUIUtility.labelWidth = before;
            EditorGUILayout.Space(4f);
            DrawLearning(session);
            if (hasResult)
            {
                EditorGUILayout.HelpBox(report, MessageType.None);
            }
            if (problem.Length > 0)
            {
                EditorGUILayout.HelpBox(problem, MessageType.Error);
            }
            EditorGUILayout.Space(4f);
            DrawViews();
            DrawPlayer(player);
            DrawSaving();
        }

        /// <summary>Describes a recording in one or two sentences.</summary>
        internal static string Describe(Recording recording)
        {
            string motion = !recording.KnowsSpeed ? "speed unknown"
                : recording.ConstantVelocityMps is { } velocity
                    ? Text("speed {0:0.###} m/s", Math.Sqrt(velocity.X * velocity.X + velocity.Y * velocity.Y))
                    : "speed from the file";
            string force = !recording.KnowsForce ? "force unknown"
                : recording.ConstantForceNewtons is { } newtons ? Text("force {0:0.###} N", newtons)
                : "force from the file";
            string description = Text("{0}: {1:0.0} s, {2} at {3:0} Hz, {4}, {5}.", recording.Name, recording.Seconds,
                recording.AxisCount == 1 ? "one axis" : "three axes", recording.SampleRateHz, motion, force);
            return string.Join(" ", new[] { description }.Concat(recording.Remarks));
        }

        private void LayOut(NewMaterialSession session, HapticModelAsset? model)
        {
            learns = session.Learning != null;
            hasResult = state.Material.Length > 0;
            hasCurves = session.Report?.HasCurves == true;
            report = session.Report?.Sentences ?? "";
            obstacle = session.Obstacle(model) ?? "";
            problem = session.Problem ?? "";
            found = session.Recording != null
                ? Describe(session.Recording)
                : state.Path.Length > 0 ? Path.GetFileName(state.Path) : "";
        }

        private void DrawMotion(Recording? recording)
        {
            DrawNumber(Speed, state.SpeedMps, NewMaterialState.MaximumSpeedMps, recording?.KnowsSpeed == true,
                (changed, number) => changed.SpeedMps = number);
            DrawNumber(Force, state.ForceNewtons, NewMaterialState.MaximumForceNewtons, recording?.KnowsForce == true,
                (changed, number) => changed.ForceNewtons = number);
            bool isWave = state.Path.EndsWith(".wav", StringComparison.OrdinalIgnoreCase) ||
                state.Path.EndsWith(".w64", StringComparison.OrdinalIgnoreCase);
            DrawNumber(FullScale, state.FullScaleMps2, 1e5f, !isWave,
                (changed, number) => changed.FullScaleMps2 = number);
        }

        private void DrawLearning(NewMaterialSession session)
        {
            if (learns)
            {
                using (new EditorGUILayout.HorizontalScope())
                {
                    HapticLearning? learning = session.Learning;
                    Rect bar = EditorGUILayout.GetControlRect();
                    EditorGUI.ProgressBar(bar, learning?.Share ?? 1f, learning?.Doing ?? "");
                    if (GUILayout.Button(CancelButton, GUILayout.Width(ButtonWidth)))
                    {
                        session.Cancel();
                    }
                }
                return;
            }
            using (new EditorGUI.DisabledScope(obstacle.Length > 0))
            {
                if (GUILayout.Button(LearnButton))
                {
                    LearnPressed?.Invoke();
                }
            }
            if (obstacle.Length > 0)
            {
                EditorGUILayout.HelpBox(obstacle, MessageType.Info);
            }
        }

        private void DrawViews()
        {
            using (new EditorGUI.DisabledScope(!hasCurves))
            {
                int view = hasCurves && state.ShowsCurves ? 1 : 0;
                state.Enter("View", view, GUILayout.Toolbar(view, Views),
                    (changed, chosen) => changed.ShowsCurves = chosen == 1);
            }
        }

        private void DrawPlayer(NewMaterialPlayer player)
        {
            using (new EditorGUI.DisabledScope(player.PlayedSound == null || !player.IsAvailable))
            using (new EditorGUILayout.HorizontalScope())
            {
                if (GUILayout.Button(player.IsPlaying ? Stop : Play, GUILayout.Width(56f)))
                {
                    player.Toggle();
                }
                state.Enter("Side", state.Active, GUILayout.Toolbar(state.Active, Sides),
                    (changed, side) => changed.Active = side);
            }
            using (new EditorGUILayout.HorizontalScope())
            {
                DrawSwitch(Loop, state.Loops, (changed, value) => changed.Loops = value);
                DrawSwitch(Match, state.MatchesLevels, (changed, value) => changed.MatchesLevels = value);
            }
        }

        private void DrawSaving()
        {
            using (new EditorGUI.DisabledScope(!hasResult))
            {
                if (GUILayout.Button(SaveButton))
                {
                    SavePressed?.Invoke();
                }
                if (GUILayout.Button(ExportButton))
                {
                    ExportPressed?.Invoke();
                }
            }
        }

        private void DrawNumber(GUIContent title, float value, float maximum, bool isKnown,
            Action<NewMaterialState, float> change)
        {
            using (new EditorGUI.DisabledScope(isKnown))
            {
                float entered = Mathf.Clamp(EditorGUILayout.FloatField(title, value), 0f, maximum);
                state.Enter(title.text.Split(' ')[0], value, float.IsNaN(entered) ? value : entered, change);
            }
        }

        private void DrawText(GUIContent title, string value, Action<NewMaterialState, string> change) =>
            state.Enter(title.text, value, EditorGUILayout.TextField(title, value), change);

        private void DrawSwitch(GUIContent title, bool value, Action<NewMaterialState, bool> change) =>
            state.Enter(title.text, value, GUILayout.Toggle(value, title), change);

        private static string Text(string format, params object[] values) =>
            string.Format(CultureInfo.InvariantCulture, format, values);
    }

    /// <summary>The tooltips of <see cref="LearningPanel"/>. Main thread, within OnGUI.</summary>
    internal static class CurveTips
    {
        private static readonly GUIContent Spectra = new GUIContent("",
            "The power at each frequency, with one chart for each range of speed that was recorded. The learnt line " +
            "should lie on the recorded one.");
        private static readonly GUIContent Levels = new GUIContent("",
            "The strength over speed, with one chart for each range of force. Points were recorded, the shaded range " +
            "holds their speeds, and the learnt line is dashed where it is extrapolated.");
        private static readonly GUIContent Kurtosis = new GUIContent("",
            "How rare and strong single events are at each speed. Even noise has 3, knocks and crackles have more.");
        private static readonly GUIContent Ribs = new GUIContent("",
            "The share of the ribs in the vibration at each speed. At 0 dB there is nothing but ribs, at -40 dB there " +
            "are none.");

        /// <param name="charts">The box of the panel.</param>
        public static void Draw(Box charts)
        {
            GUI.Label(LearningPanel.Spectra(charts).ToRect(), Spectra, GUIStyle.none);
            GUI.Label(LearningPanel.Levels(charts).ToRect(), Levels, GUIStyle.none);
            GUI.Label(LearningPanel.Kurtosis(charts).ToRect(), Kurtosis, GUIStyle.none);
            GUI.Label(LearningPanel.Ribs(charts).ToRect(), Ribs, GUIStyle.none);
        }
    }
}
