#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>What plays an output's channel.</summary>
    public enum OutputActuator
    {
        /// <summary>Nothing is said of it: the wave leaves as it is.</summary>
        Uncompensated,

        /// <summary>A voice coil with resonances near 160 and 320 Hz, by the library's approximate profile.</summary>
        VoiceCoil,

        /// <summary>The one of a measured profile: see haptoflow actuator identify.</summary>
        Profile,
    }

    /// <summary>What an output's voices go through on their way to the device. What is not asked for does not run.
    /// Main thread.</summary>
    [Serializable]
    public sealed class OutputProcessing
    {
        /// <summary>The longest delay, in ms.</summary>
        public const float MaximumDelayMilliseconds = 500f;

        [SerializeField, Tooltip("What plays the channel: its resonances and weak bands are evened out.")]
        private OutputActuator actuator;

        [SerializeField, Tooltip("A measured actuator profile (JSON), for the actuator Profile.")]
        private TextAsset? profile;

        [SerializeField, Tooltip("Lowers slowly what has been strong for too long. It is no medical device.")]
        private bool exposureGuard;

        [SerializeField, Range(0f, MaximumDelayMilliseconds),
         Tooltip("Everything comes this much later, in ms: for studies, and displays that lag.")]
        private float delayMilliseconds;

        /// <summary>What plays the channel.</summary>
        public OutputActuator Actuator
        {
            get => actuator;
            set => actuator = value;
        }

        /// <summary>A measured profile as JSON, for <see cref="OutputActuator.Profile"/>.</summary>
        public TextAsset? Profile
        {
            get => profile;
            set => profile = value;
        }

        /// <summary>Lowers slowly what has been strong for too long. No medical device.</summary>
        public bool ExposureGuard
        {
            get => exposureGuard;
            set => exposureGuard = value;
        }

        /// <summary>0 to <see cref="MaximumDelayMilliseconds"/>.</summary>
        public float DelayMilliseconds
        {
            get => delayMilliseconds;
            set => delayMilliseconds = Mathf.Clamp(value, 0f, MaximumDelayMilliseconds);
        }

        /// <summary>The actuator needs a profile and has none.</summary>
        internal bool LacksProfile => actuator == OutputActuator.Profile && profile == null;

        /// <summary>Asks a voice for all of this. A profile that cannot be used is left out with an error.</summary>
        internal void Apply(HapticVoice voice, HapticOutput owner)
        {
            voice.SetDelay(0.001 * delayMilliseconds);
            voice.SetExposureGuard(exposureGuard);
            try
            {
                voice.SetActuator(ProfileText());
            }
            catch (HaptoFlowException refusal) when (actuator == OutputActuator.Profile)
            {
                voice.SetActuator(null);
                Debug.LogError($"HaptoFlow: {owner.name} plays uncompensated: {profile!.name} is no actuator profile " +
                    $"({refusal.Message}).", owner);
            }
        }

        private string? ProfileText() => actuator switch
        {
            OutputActuator.VoiceCoil => "voice-coil",
            OutputActuator.Profile when profile != null => profile.text,
            _ => null,
        };
    }
}
