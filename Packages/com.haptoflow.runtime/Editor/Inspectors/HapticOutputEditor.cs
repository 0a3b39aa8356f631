#nullable enable
using System;
using System.Globalization;
using HaptoFlow.Outputs;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of an output. In play mode, it shows level, underruns and times. It draws its own level
    /// meter, because Unity shows the meter of audio filters in the default Inspector only.</summary>
    [CustomEditor(typeof(HapticOutput))]
    [CanEditMultipleObjects]
    internal sealed class HapticOutputEditor : UnityEditor.Editor
    {
        private static readonly GUIContent Profile = new GUIContent("Actuator Profile");
        private static readonly GUIContent Delay = new GUIContent("Delay (ms)");
        private static readonly GUIContent Panic = new GUIContent("Panic",
            "Panic silences the output at once. Each stylus plays again from its next touch-down on.");

        private readonly OutputReadout readout = new OutputReadout();
        private SerializedProperty route = null!;
        private SerializedProperty channel = null!;
        private SerializedProperty actuator = null!;

        private void OnEnable()
        {
            route = serializedObject.FindProperty("route");
            channel = serializedObject.FindProperty("channel");
            actuator = serializedObject.FindProperty("processing.actuator");
        }

        public override bool RequiresConstantRepaint() => Application.isPlaying;

        public override void OnInspectorGUI()
        {
            serializedObject.Update();
            // Read before any field is drawn, so that layout and drawing show the same fields.
            bool byMixer = route.enumValueIndex == (int)OutputRoute.MixerEffect;
            bool bySource = route.enumValueIndex == (int)OutputRoute.AudioSource;
            bool lacksChannel = route.enumValueIndex == (int)OutputRoute.ListenerChannel && channel.intValue < 0;
            bool several = route.hasMultipleDifferentValues;
            bool byProfile = actuator.enumValueIndex == (int)OutputActuator.Profile;
            using (new EditorGUI.DisabledScope(Application.isPlaying))
            {
                EditorGUILayout.PropertyField(route);
            }
            DrawDestination(several || !byMixer, several || byMixer);
            EditorGUILayout.PropertyField(serializedObject.FindProperty("playWhilePaused"));
            if (several || bySource)
            {
                EditorGUILayout.PropertyField(serializedObject.FindProperty("obeyListener"));
            }
            if (lacksChannel && !several)
            {
                EditorGUILayout.HelpBox("Choose a channel from 0. With -1 the output would overwrite all game audio, " +
                    "so it stays silent.", MessageType.Error);
            }
            EditorGUILayout.PropertyField(serializedObject.FindProperty("strength"));
            EditorGUILayout.PropertyField(serializedObject.FindProperty("muted"));
            EditorGUILayout.PropertyField(serializedObject.FindProperty("processing.listen"));
            EditorGUILayout.PropertyField(actuator);
            if (byProfile || actuator.hasMultipleDifferentValues)
            {
                EditorGUILayout.PropertyField(serializedObject.FindProperty("processing.profile"), Profile);
            }
            EditorGUILayout.PropertyField(serializedObject.FindProperty("processing.exposureGuard"));
            EditorGUILayout.PropertyField(serializedObject.FindProperty("processing.delayMilliseconds"), Delay);
            if (serializedObject.ApplyModifiedProperties())
            {
                ApplyToVoices();
            }
            if (Application.isPlaying && targets.Length == 1)
            {
                DrawLive((HapticOutput)target);
            }
        }

        private void DrawDestination(bool toChannel, bool byMixer)
        {
            if (toChannel)
            {
                EditorGUILayout.PropertyField(channel);
            }
            if (byMixer)
            {
                EditorGUILayout.PropertyField(serializedObject.FindProperty("audioMixer"));
                EditorGUILayout.PropertyField(serializedObject.FindProperty("voiceParameter"));
            }
        }

        /// <summary>Passes changed fields on to the voices, which only the properties do.</summary>
        private void ApplyToVoices()
        {
            foreach (Object each in targets)
            {
                if (Application.isPlaying)
                {
                    var output = (HapticOutput)each;
                    output.Muted = output.Muted;
                    output.ApplyProcessing();
                }
            }
        }

        private void DrawLive(HapticOutput output)
        {
            readout.Update(output);
            EditorGUILayout.Space();
            if (output.Route != OutputRoute.MixerEffect)
            {
                LevelMeter.Draw(EditorGUILayout.GetControlRect(), output.Level);
            }
            readout.Draw();
            if (GUILayout.Button(Panic))
            {
                output.Panic();
            }
        }
    }

    /// <summary>The state of an output in play mode: times, underruns, and the engine that feeds it.</summary>
    internal sealed class OutputReadout : Readout<HapticOutput>
    {
        private int voices;
        private ulong underruns;
        private ulong limited;

        protected override void Read(HapticOutput output)
        {
            voices = 0;
            underruns = 0;
            limited = 0;
            output.ForEachVoice((voice, readout) => readout.Count(voice), this);
            Add("Voices", "{0}", voices);
            Add("Underruns", "{0}", underruns);
            Add("Limited samples", "{0}", limited);
            if (output.Route != OutputRoute.MixerEffect)
            {
                Add("Rendering a block", "{0:0.000} ms, at worst {1:0.000} ms",
                    output.RenderMilliseconds, output.WorstRenderMilliseconds);
            }
            Add("Device", "{0} Hz", output.SampleRateHz);
            if (Haptics.TryGetStatistics(out EngineStatistics engine))
            {
                Add("Inference", "{0:0.00} ms a round, budget {1:0.00} ms", engine.LastRoundMs, engine.BudgetMs);
                Add("Quality", TierOf(engine));
                AddHealth(engine);
            }
        }

        private void AddHealth(in EngineStatistics engine)
        {
            if (!engine.WorkerIsAlive)
            {
                Add("Worker", "has ended; Haptics.Restart starts it again");
            }
            if (engine.PriorityWasRefused)
            {
                Add("Worker priority", "refused by the system, so more segments are late");
            }
            string failure = engine.FailedRounds > 0 || !engine.WorkerIsAlive ? Haptics.LastFailure : "";
            if (failure.Length > 0)
            {
                Add("Last failure", failure);
            }
        }

        private void Count(HapticVoice voice)
        {
            VoiceStatistics statistics = voice.Statistics();
            ++voices;
            underruns += statistics.Underruns;
            limited += statistics.LimitedSamples;
        }

        private static string TierOf(in EngineStatistics engine)
        {
            string tier = NameOf((int)engine.Tier);
            return engine.IsMeasuring ? tier + ", measuring" : tier;
        }

        private static string NameOf(int tier)
        {
            HapticModelAsset? model = HaptoFlowSettings.Active.Model;
            try
            {
                return model != null && tier < model.Header.Tiers.Count
                    ? model.Header.Tiers[tier].Name
                    : "tier " + tier.ToString(CultureInfo.InvariantCulture);
            }
            catch (HaptoFlowException)
            {
                // The settings now name a damaged model, while the engine still runs with the previous one.
                return "of the previous model";
            }
        }
    }

    /// <summary>Draws a level as a bar from -60 dB to full scale.</summary>
    internal static class LevelMeter
    {
        private const double MinimumDecibels = -60.0;

        public static void Draw(Rect place, float level)
        {
            (float share, string caption) = Of(level);
            EditorGUI.ProgressBar(place, share, caption);
        }

        /// <summary>The length of the bar, from 0 to 1, and the level in whole decibels.</summary>
        public static (float Share, string Caption) Of(float level)
        {
            double decibels = level > 0f ? Math.Max(MinimumDecibels, 20.0 * Math.Log10(level)) : MinimumDecibels;
            return ((float)Math.Min(1.0, 1.0 - decibels / MinimumDecibels), decibels > MinimumDecibels + 0.5
                ? SummaryRow.Format("level {0} dB of full scale", (int)Math.Round(decibels))
                : "silent");
        }
    }

    /// <summary>The Inspector of the outputs for devices in a hand. In play mode it shows which device is driven, in
    /// which form, and how late and how evenly it is fed.</summary>
    [CustomEditor(typeof(DeviceOutput), true)]
    [CanEditMultipleObjects]
    internal sealed class DeviceOutputEditor : UnityEditor.Editor
    {
        private static readonly GUIContent Panic = new GUIContent("Panic",
            "Panic silences the output at once. The stylus plays again from its next touch-down on.");

        private readonly DeviceReadout readout = new DeviceReadout();

        public override bool RequiresConstantRepaint() => Application.isPlaying;

        public override void OnInspectorGUI()
        {
            if (DrawDefaultInspector() && Application.isPlaying)
            {
                foreach (Object each in targets)
                {
                    // The voices learn of a changed field by the property only.
                    var changed = (DeviceOutput)each;
                    changed.Muted = changed.Muted;
                }
            }
            if (!Application.isPlaying || targets.Length != 1)
            {
                return;
            }
            var output = (DeviceOutput)target;
            readout.Update(output);
            EditorGUILayout.Space();
            readout.Draw();
            if (GUILayout.Button(Panic))
            {
                output.Panic();
            }
        }
    }

    /// <summary>The state of an output for a device in play mode: device, form, delay and gaps.</summary>
    internal sealed class DeviceReadout : Readout<DeviceOutput>
    {
        protected override void Read(DeviceOutput output)
        {
            HapticForm? form = output.Form;
            if (form == null)
            {
                Add("Device", output.SearchedHand == HapticHand.None
                    ? "none: the stylus is in no hand, so choose one in Hand"
                    : "none in the {0} hand that takes this output", output.SearchedHand.InWords());
                return;
            }
            HapticQueueStatistics statistics = output.Statistics;
            Add("Device", "{0}, {1} hand", output.DeviceName, output.SearchedHand.InWords());
            Add("Form", NameOf(form.Value));
            Add("Latency", statistics.LatencyMilliseconds > 0.0
                ? "{0:0.0} ms, without device and radio" : "nothing plays", statistics.LatencyMilliseconds);
            if (statistics.RateHz > 0.0)
            {
                Add("Rate", "{0:0} Hz", statistics.RateHz);
            }
            Add("Submissions", "{0}", statistics.Submissions);
            Add("Gaps", "{0}", statistics.Gaps);
            Add("Realigned", "{0} times", statistics.Alignments);
            Add("Stopped", "{0} times", statistics.Stops);
            Add("Device changed", "{0} times", statistics.DeviceChanges);
        }

        private static string NameOf(HapticForm form) => form switch
        {
            HapticForm.Waveform => "the waveform itself",
            HapticForm.Parametric => "amplitude and frequency over time",
            _ => "one amplitude at a time",
        };
    }
}
