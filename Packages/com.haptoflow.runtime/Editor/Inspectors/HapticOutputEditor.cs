#nullable enable
using UnityEditor;
using UnityEngine;

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
}
