#nullable enable
namespace HaptoFlow.Editor
{
    /// <summary>What a stylus touches, and the state of its voice.</summary>
    internal sealed class StylusReadout : Readout<HapticStylus>
    {
        private const double SamplesPerMillisecond = 2.0;

        private static readonly string[] EffectNames =
        {
            "Texture", "Impact", "Edge", "Delay", "Compensation", "Exposure Guard", "Tone", "Signal",
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
            for (HapticEffect effect = HapticEffect.Impact; effect <= HapticEffect.Signal; ++effect)
            {
                if (!stylus.TryGetEffectStatistics(effect, out EffectStatistics stage) ||
                    (stage.Prepared == 0 && !stage.IsAskedFor))
                {
                    continue;
                }
                double microseconds = stage.Runs > 0 ? stage.Microseconds / stage.Runs : 0.0;
                string counted = effect == HapticEffect.Signal
                    ? "started {0} times, {1:0.0} us a block"
                    : "{0} impacts, {1:0.0} us a block";
                Add(EffectNames[(int)effect],
                    stage.Events > 0 ? counted : "{1:0.0} us a block", stage.Events, microseconds);
            }
        }
    }
}
