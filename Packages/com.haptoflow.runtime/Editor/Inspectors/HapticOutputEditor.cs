#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of an output: its way to the device; in play mode level, underruns and times. It draws
    /// a meter of its own, since Unity shows its one for audio filters in the default Inspector only.</summary>
    [CustomEditor(typeof(HapticOutput))]
    [CanEditMultipleObjects]
    internal sealed class HapticOutputEditor : UnityEditor.Editor
    {
        private static readonly GUIContent Route = new GUIContent("Route",
            "Audio Source: plays beside other sounds. Listener Channel: overwrites one channel, nothing else is " +
            "heard there. Mixer Effect: the native library plays inside an Audio Mixer. Chosen before the first " +
            "frame.");
        private static readonly GUIContent Channel = new GUIContent("Channel",
            "Of the audio device, from 0; -1 for all. A channel that the device does not have is silent. Listener " +
            "Channel needs one from 0.");
        private static readonly GUIContent Strength = new GUIContent("Strength", "Gain, 0 to 1.");
        private static readonly GUIContent Muted = new GUIContent("Muted", "Silent, and costs no inference.");
        private static readonly GUIContent Obey = new GUIContent("Obey Listener",
            "AudioListener.pause and AudioListener.volume reach the haptics too. Off, a game that turns its sound " +
            "down keeps what the hand feels.");
        private static readonly GUIContent Mixer = new GUIContent("Audio Mixer",
            "The mixer that holds the effect HaptoFlow Voice.");
        private static readonly GUIContent Parameter = new GUIContent("Voice Parameter",
            "The name under which the effect's parameter Voice is exposed in that mixer.");
        private static readonly GUIContent Actuator = new GUIContent("Actuator",
            "What plays the channel: its resonances and weak bands are evened out. Uncompensated costs nothing.");
        private static readonly GUIContent Profile = new GUIContent("Actuator Profile",
            "A measured profile (JSON), as haptoflow actuator identify writes it.");
        private static readonly GUIContent Guard = new GUIContent("Exposure Guard",
            "Lowers slowly what has been strong for too long. It is no medical device.");
        private static readonly GUIContent Delay = new GUIContent("Delay (ms)",
            "Everything comes this much later: for studies, and displays that lag.");
        private static readonly GUIContent Panic = new GUIContent("Panic",
            "Silence at once; each stylus sounds again with its next touch-down.");

        private readonly OutputReadout readout = new OutputReadout();
        private SerializedProperty route = null!;
        private SerializedProperty channel = null!;
        private SerializedProperty strength = null!;
        private SerializedProperty muted = null!;
        private SerializedProperty obey = null!;
        private SerializedProperty mixer = null!;
        private SerializedProperty parameter = null!;
        private SerializedProperty actuator = null!;
        private SerializedProperty profile = null!;
        private SerializedProperty guard = null!;
        private SerializedProperty delay = null!;

        private void OnEnable()
        {
            route = serializedObject.FindProperty("route");
            channel = serializedObject.FindProperty("channel");
            strength = serializedObject.FindProperty("strength");
            muted = serializedObject.FindProperty("muted");
            obey = serializedObject.FindProperty("obeyListener");
            mixer = serializedObject.FindProperty("audioMixer");
            parameter = serializedObject.FindProperty("voiceParameter");
            actuator = serializedObject.FindProperty("processing.actuator");
            profile = serializedObject.FindProperty("processing.profile");
            guard = serializedObject.FindProperty("processing.exposureGuard");
            delay = serializedObject.FindProperty("processing.delayMilliseconds");
        }

        public override bool RequiresConstantRepaint() => Application.isPlaying;

        public override void OnInspectorGUI()
        {
            serializedObject.Update();
            // What is shown is decided before anything is changed: nothing is drawn that was not laid out.
            bool byMixer = route.enumValueIndex == (int)OutputRoute.MixerEffect;
            bool bySource = route.enumValueIndex == (int)OutputRoute.AudioSource;
            bool lacksChannel = route.enumValueIndex == (int)OutputRoute.ListenerChannel && channel.intValue < 0;
            bool several = route.hasMultipleDifferentValues;
            bool byProfile = actuator.enumValueIndex == (int)OutputActuator.Profile;
            using (new EditorGUI.DisabledScope(Application.isPlaying))
            {
                EditorGUILayout.PropertyField(route, Route);
            }
            DrawWay(several || !byMixer, several || byMixer);
            if (several || bySource)
            {
                EditorGUILayout.PropertyField(obey, Obey);
            }
            if (lacksChannel && !several)
            {
                EditorGUILayout.HelpBox("Choose a channel from 0: with -1 all game audio would be overwritten, so " +
                    "this output stays silent.", MessageType.Error);
            }
            EditorGUILayout.PropertyField(strength, Strength);
            EditorGUILayout.PropertyField(muted, Muted);
            EditorGUILayout.PropertyField(actuator, Actuator);
            if (byProfile || actuator.hasMultipleDifferentValues)
            {
                EditorGUILayout.PropertyField(profile, Profile);
            }
            EditorGUILayout.PropertyField(guard, Guard);
            EditorGUILayout.PropertyField(delay, Delay);
            if (serializedObject.ApplyModifiedProperties())
            {
                TakeOver();
            }
            if (Application.isPlaying && targets.Length == 1)
            {
                DrawLive((HapticOutput)target);
            }
        }

        private void DrawWay(bool toChannel, bool byMixer)
        {
            if (toChannel)
            {
                EditorGUILayout.PropertyField(channel, Channel);
            }
            if (byMixer)
            {
                EditorGUILayout.PropertyField(mixer, Mixer);
                EditorGUILayout.PropertyField(parameter, Parameter);
            }
        }

        /// <summary>Voices learn of a change only from the property.</summary>
        private void TakeOver()
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
            ReadoutView.Draw("Now", readout.Rows);
            if (GUILayout.Button(Panic))
            {
                output.Panic();
            }
        }
    }
}
