#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The actuator that plays an output's channel.</summary>
    public enum OutputActuator
    {
        /// <summary>Unknown: the wave is not compensated.</summary>
        Uncompensated,

        /// <summary>A voice coil with resonances near 160 and 320 Hz: the library's approximate profile.</summary>
        VoiceCoil,

        /// <summary>The actuator of a measured profile: see haptoflow actuator identify.</summary>
        Profile,
    }

    /// <summary>Processing of an output's voices before the device. Stages that are off cost nothing. Main
    /// thread.</summary>
    [Serializable]
    public sealed class OutputProcessing
    {
        /// <summary>Upper limit of the delay, in ms.</summary>
        public const float MaximumDelayMilliseconds = 500f;

        [SerializeField, Tooltip("The actuator plays the channel. A compensation evens out its resonances and weak " +
            "bands; Uncompensated takes no time.")]
        private OutputActuator actuator;

        [SerializeField, Tooltip("The actuator profile is a measured one (JSON), as haptoflow actuator identify " +
            "writes it.")]
        private TextAsset? profile;

        [SerializeField, Tooltip("The exposure guard slowly lowers a level that has been high for too long. It is no " +
            "medical device.")]
        private bool exposureGuard;

        [SerializeField, Range(0f, MaximumDelayMilliseconds), Tooltip("The output is delayed by this time, for " +
            "studies and for displays that lag.")]
        private float delayMilliseconds;

        [SerializeField, Tooltip("Makes the vibration audible on loudspeakers: louder and brighter. It is for ears " +
            "only: it has no effect with an actuator chosen, or with a channel of the output's own.")]
        private bool listen;

        /// <summary>The actuator that plays the channel.</summary>
        public OutputActuator Actuator { get => actuator; set => actuator = value; }

        /// <summary>A measured profile as JSON, for <see cref="OutputActuator.Profile"/>.</summary>
        public TextAsset? Profile { get => profile; set => profile = value; }

        /// <summary>True to lower slowly what has been strong for too long. Not a medical device.</summary>
        public bool ExposureGuard { get => exposureGuard; set => exposureGuard = value; }

        /// <summary>Added delay, 0 to <see cref="MaximumDelayMilliseconds"/>.</summary>
        public float DelayMilliseconds
        {
            get => delayMilliseconds;
            set => delayMilliseconds = Mathf.Clamp(value, 0f, MaximumDelayMilliseconds);
        }

        /// <summary>True to make the vibration audible on loudspeakers: louder and brighter. For ears only: it has no
        /// effect with an actuator, or on an output with a channel of its own.</summary>
        public bool Listen { get => listen; set => listen = value; }

        /// <summary>True where Listen is on and has no effect, because an actuator or the channel that one is wired to
        /// is chosen: it would be far too strong there.</summary>
        internal bool ListensInVain(HapticOutput owner) =>
            listen && (actuator != OutputActuator.Uncompensated || owner.HasOwnChannel);

        internal bool LacksProfile => actuator == OutputActuator.Profile && profile == null;

        /// <summary>Applies the settings to a voice. A profile that cannot be used is skipped with an error.</summary>
        internal void Apply(HapticVoice voice, HapticOutput owner)
        {
            voice.SetDelay(0.001 * delayMilliseconds);
            voice.SetExposureGuard(exposureGuard);
            voice.SetListen(listen && !ListensInVain(owner));
            try
            {
                voice.SetActuator(ProfileText());
            }
            catch (HaptoFlowException refusal) when (actuator == OutputActuator.Profile)
            {
                voice.SetActuator(null);
                Debug.LogError($"HaptoFlow: {owner.name} plays uncompensated: {profile!.name} is not an actuator " +
                    $"profile ({refusal.Message}).", owner);
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
