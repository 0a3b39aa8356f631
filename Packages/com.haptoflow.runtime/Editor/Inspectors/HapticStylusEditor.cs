#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a stylus. In play mode it shows what the stylus touches, and its voice.</summary>
    [CustomEditor(typeof(HapticStylus))]
    [CanEditMultipleObjects]
    internal sealed class HapticStylusEditor : UnityEditor.Editor
    {
        private const string TouchBy = "touchBy";
        private const string ForceFields = "forceDecision.";

        /// <summary>The fields in the order of drawing; a title stands where the name does not say enough.</summary>
        private static readonly (string Field, GUIContent? Title)[] Fields =
        {
            ("tip", null), ("tipRadiusMetres", new GUIContent("Tip Radius (m)")), ("layers", null), ("update", null),
            ("force", new GUIContent("Tip Force")), (TouchBy, null),
            ("forceDecision.pressNewtons", new GUIContent("Press Force (N)")),
            ("forceDecision.releaseNewtons", new GUIContent("Release Force (N)")),
            ("forceDecision.nearMetres", new GUIContent("Near (m)")), ("output", null), ("hand", null),
            ("strength", null), ("rig", null), ("events.touchBegan", null), ("events.touchMoved", null),
            ("events.surfaceChanged", null), ("events.touchEnded", null),
        };

        private readonly StylusReadout readout = new StylusReadout();
        private SerializedProperty[] properties = null!;

        private void OnEnable() =>
            properties = System.Array.ConvertAll(Fields, field => serializedObject.FindProperty(field.Field));

        public override bool RequiresConstantRepaint() => Application.isPlaying;

        public override void OnInspectorGUI()
        {
            serializedObject.Update();
            // Read before any field is drawn, so that layout and drawing show the same fields.
            bool byForce = Property(TouchBy).enumValueIndex == (int)TouchDecision.MeasuredForce;
            bool lacksForce = byForce && Property("force").objectReferenceValue == null;
            for (int index = 0; index < properties.Length; ++index)
            {
                if (byForce || !Fields[index].Field.StartsWith(ForceFields, System.StringComparison.Ordinal))
                {
                    EditorGUILayout.PropertyField(properties[index], Fields[index].Title);
                }
            }
            if (lacksForce && targets.Length == 1)
            {
                EditorGUILayout.HelpBox("The field Tip Force is empty, so geometry decides.", MessageType.Info);
            }
            serializedObject.ApplyModifiedProperties();
            if (!Application.isPlaying || targets.Length > 1)
            {
                return;
            }
            readout.Update((HapticStylus)target);
            EditorGUILayout.Space();
            readout.Draw();
        }

        private SerializedProperty Property(string field) =>
            properties[System.Array.FindIndex(Fields, each => each.Field == field)];
    }

    /// <summary>What a stylus touches, and the state of its voice.</summary>
    internal sealed class StylusReadout : Readout<HapticStylus>
    {
        private const double SamplesPerMillisecond = 2.0;

        private static readonly string[] EffectNames =
        {
            "Texture", "Impact", "Edge", "Delay", "Compensation", "Exposure Guard", "Tone", "Signal",
            "Listen", "Relief", "Clip",
        };

        protected override void Read(HapticStylus stylus)
        {
            if (Haptics.Problem != null)
            {
                Add("Problem", Haptics.Problem);
            }
            if (stylus.IsTouching)
            {
                HapticContact contact = stylus.Contact;
                Add("Touches", contact.Collider != null ? contact.Collider.name : "an object that no longer exists");
                Add("Feels like", MaterialWords.Of(contact));
                Add("Because of", contact.Explain());
                Add("Force", "{0:0.00} N", contact.ForceNewtons);
                Add("Speed", "{0:0} mm/s", 1000.0 * contact.TangentialVelocity.magnitude);
                Add("Penetration", "{0:0.0} mm", 1000.0 * contact.PenetrationMetres);
                if (stylus.TryGetRelief(out HapticRelief relief, out MapPlace place) && relief.Heights is { } heights)
                {
                    Add("Height", "{0:0.00} mm of {1}", 1000.0 * heights.MetresAt(place), relief.name);
                }
            }
            else
            {
                Add("Touches", "nothing");
            }
            if (!stylus.TryGetStatistics(out VoiceStatistics voice))
            {
                Add("Voice", SilenceWords.OfMissingVoice(stylus));
                return;
            }
            Add("Silence", SilenceWords.Of(voice));
            Add("Segments", "{0}, {1} late", voice.Inferences, voice.Late);
            if (voice.Inferences > 0)
            {
                Add("Inference", "{0:0.00} ms a segment", voice.InferenceMilliseconds / voice.Inferences);
            }
            Add("Underruns", "{0}", voice.Underruns);
            Add("Lead", "{0:0.0} ms", voice.LeadSamples / SamplesPerMillisecond);
            ReadEffects(stylus);
            ulong corrected = voice.Sanitised + voice.NonFiniteSamples + voice.Failures;
            if (corrected > 0)
            {
                Add("Corrected", "{0} inputs, {1} samples, {2} failed runs",
                    voice.Sanitised, voice.NonFiniteSamples, voice.Failures);
            }
        }

        /// <summary>Adds the effects that run or have run.</summary>
        private void ReadEffects(HapticStylus stylus)
        {
            for (HapticEffect effect = HapticEffect.Impact; effect <= HapticEffect.Clip; ++effect)
            {
                if (!stylus.TryGetEffectStatistics(effect, out EffectStatistics stage) ||
                    (stage.Prepared == 0 && !stage.IsAskedFor))
                {
                    continue;
                }
                double microseconds = stage.Runs > 0 ? stage.Microseconds / stage.Runs : 0.0;
                string counted = effect == HapticEffect.Signal || effect == HapticEffect.Clip
                    ? "started {0} times, {1:0.0} us a block"
                    : "{0} impacts, {1:0.0} us a block";
                Add(EffectNames[(int)effect],
                    stage.Events > 0 ? counted : "{1:0.0} us a block", stage.Events, microseconds);
            }
        }
    }

    /// <summary>Describes why nothing is felt, with the remedy where there is one.</summary>
    internal static class SilenceWords
    {
        public static string Of(in VoiceStatistics voice) => voice.Silence switch
        {
            HapticSilence.None => "none: it plays",
            HapticSilence.Rest => "rest: nothing touches, or the tip does not slide",
            HapticSilence.Stale => "stale: no contact state came for 100 ms",
            HapticSilence.Muted => "muted",
            HapticSilence.Paused => "paused: with the application, or by AudioListener.pause",
            HapticSilence.Panic => "panic: it plays again from the next touch-down on",
            HapticSilence.Rate when !voice.IsRateSupported =>
                $"the device's sample rate is outside {OutputRules.MinimumRateHz} to {OutputRules.MaximumRateHz} Hz",
            HapticSilence.Rate => "the device changed its sample rate",
            HapticSilence.Closing => "the voice is being closed",
            HapticSilence.WorkerDead => "the worker thread has ended",
            HapticSilence.TurnedDown => "turned down: a strength or the ceiling is 0",
            _ => "unknown reason " + (int)voice.Silence,
        };

        public static string OfMissingVoice(HapticStylus stylus)
        {
            HapticOutput? output = stylus.Output;
            if (output != null && !output.isActiveAndEnabled)
            {
                return $"none: {output.name} is switched off";
            }
            if (output == null && SceneOutputs.AreSwitchedOff)
            {
                return "none: the scene's output is switched off";
            }
            if (output == null && UnityAudio.Problem != null)
            {
                return "none: " + UnityAudio.Problem;
            }
            return stylus.isActiveAndEnabled ? "none yet" : "none: the stylus is switched off";
        }
    }
}
