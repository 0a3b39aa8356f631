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
        private static readonly GUIContent Route = new GUIContent("Route",
            "The route leads the wave to the audio device. Audio Source plays beside other sounds. Listener Channel " +
            "overwrites one channel. Mixer Effect plays inside an Audio Mixer. The route is fixed once the scene " +
            "plays.");
        private static readonly GUIContent Channel = new GUIContent("Channel",
            "The wave plays on this channel of the audio device, counted from 0; -1 plays on all channels. A channel " +
            "that the device does not have is silent. The route Listener Channel needs a channel from 0.");
        private static readonly GUIContent Strength = new GUIContent("Strength",
            "Strength is the gain of this output, from 0 to 1.");
        private static readonly GUIContent Muted = new GUIContent("Muted",
            "A muted output is silent, and runs no inference.");
        private static readonly GUIContent ObeyListener = new GUIContent("Obey Listener",
            "AudioListener.pause and AudioListener.volume also apply to the haptics. When it is off, the haptics " +
            "stay as they are when a game turns its sound down.");
        private static readonly GUIContent Mixer = new GUIContent("Audio Mixer",
            "The Audio Mixer contains the effect HaptoFlow Voice.");
        private static readonly GUIContent Parameter = new GUIContent("Voice Parameter",
            "The mixer exposes the effect's parameter Voice under this name.");
        private static readonly GUIContent Actuator = new GUIContent("Actuator",
            "The actuator plays the channel. A compensation evens out its resonances and weak bands; Uncompensated " +
            "takes no time.");
        private static readonly GUIContent Profile = new GUIContent("Actuator Profile",
            "The actuator profile is a measured one (JSON), as haptoflow actuator identify writes it.");
        private static readonly GUIContent Guard = new GUIContent("Exposure Guard",
            "The exposure guard slowly lowers a level that has been high for too long. It is no medical device.");
        private static readonly GUIContent Listen = new GUIContent("Listen",
            "Makes the vibration audible on loudspeakers: louder and brighter. It is for ears only: it has no effect " +
            "with an actuator chosen, or with a channel of the output's own.");
        private static readonly GUIContent Delay = new GUIContent("Delay (ms)",
            "The output is delayed by this time, for studies and for displays that lag.");
        private static readonly GUIContent Panic = new GUIContent("Panic",
            "Panic silences the output at once. Each stylus plays again from its next touch-down on.");

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
        private SerializedProperty listen = null!;

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
            listen = serializedObject.FindProperty("processing.listen");
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
                EditorGUILayout.PropertyField(route, Route);
            }
            DrawDestination(several || !byMixer, several || byMixer);
            if (several || bySource)
            {
                EditorGUILayout.PropertyField(obey, ObeyListener);
            }
            if (lacksChannel && !several)
            {
                EditorGUILayout.HelpBox("Choose a channel from 0. With -1 the output would overwrite all game audio, " +
                    "so it stays silent.", MessageType.Error);
            }
            EditorGUILayout.PropertyField(strength, Strength);
            EditorGUILayout.PropertyField(muted, Muted);
            EditorGUILayout.PropertyField(listen, Listen);
            EditorGUILayout.PropertyField(actuator, Actuator);
            if (byProfile || actuator.hasMultipleDifferentValues)
            {
                EditorGUILayout.PropertyField(profile, Profile);
            }
            EditorGUILayout.PropertyField(guard, Guard);
            EditorGUILayout.PropertyField(delay, Delay);
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
                EditorGUILayout.PropertyField(channel, Channel);
            }
            if (byMixer)
            {
                EditorGUILayout.PropertyField(mixer, Mixer);
                EditorGUILayout.PropertyField(parameter, Parameter);
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
            ReadoutView.Draw("Now", readout.Rows);
            if (GUILayout.Button(Panic))
            {
                output.Panic();
            }
        }
    }
}
