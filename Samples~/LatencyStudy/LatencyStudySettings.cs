#nullable enable
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>Everything that a laboratory decides about the study. A session that was begun with other values cannot
    /// be resumed with these.</summary>
    [CreateAssetMenu(menuName = "HaptoFlow/Latency Study Settings", fileName = "LatencyStudySettings")]
    public sealed class LatencyStudySettings : ScriptableObject
    {
        private const double LongestStopSeconds = 0.2;

        [SerializeField, Tooltip("The order of the levels follows from this number and the participant's. It is the " +
            "same for all participants of a study.")]
        private ulong seed = 1;

        [SerializeField, Tooltip("The delays between pen and vibration, in ms, each once.")]
        private double[] levelsMilliseconds = { 50, 70, 90, 110, 130, 150, 170, 190, 210, 230, 250 };

        [SerializeField, Range((float)HapticVoice.MinimumSignalHz, (float)HapticVoice.MaximumSignalHz)]
        [Tooltip("The frequency of the vibration, in Hz.")]
        private float toneHertz = 200f;

        [SerializeField, Range(0.1f, (float)HapticVoice.MaximumSignalMps2)]
        [Tooltip("The peak of the vibration, in m/s^2. Choose the level at the " +
            "amplifier, and leave this as it is for all participants.")]
        private float toneMps2 = 20f;

        [SerializeField, Min(1f), Tooltip("How fast the marker moves, in mm/s.")]
        private float markerSpeedMmps = 150f;

        [SerializeField, Range(20f, 100f), Tooltip("The radius of the circle on which the marker moves, in mm.")]
        private float markerRadiusMillimetres = 60f;

        [SerializeField, Min(0.2f), Tooltip("How long the marker moves between two stops, in s.")]
        private float moveSeconds = 1.5f;

        [SerializeField, Min(0.2f), Tooltip("How long the marker stops, in s. It has to be longer than the longest " +
            "delay by 0.2 s.")]
        private float restSeconds = 1f;

        [SerializeField, Range(1, 20), Tooltip("How often the marker sets off and stops in a trial.")]
        private int strokes = 3;

        [SerializeField, Min(0f), Tooltip("From the audio callback to the hand, in ms: measure it as the page " +
            "latency-study of the documentation says.")]
        private float deviceDelayMilliseconds = 20f;

        [SerializeField, Tooltip("Measured is what an oscilloscope or an accelerometer showed on this set-up. Logs " +
            "and reports name the source.")]
        private DeviceDelaySource deviceDelaySource = DeviceDelaySource.Estimated;

        [SerializeField, Tooltip("How and when the device delay was measured, or what the estimate rests on.")]
        private string deviceDelayNote = "assumed by the sample, not measured on this set-up";

        [SerializeField, Min(0), Tooltip("The channel of the audio device that the actuator is wired to, from 0.")]
        private int hapticChannel = 1;

        [SerializeField, Tooltip("What the headphones play on the other channels.")]
        private NoiseColour noiseColour = NoiseColour.White;

        [SerializeField, Range(MaskingNoise.LowestDecibels, MaskingNoise.HighestDecibels),
         Tooltip("The level of the noise, in dB of full scale. The actuator must not be heard.")]
        private float noiseDecibels = -30f;

        [SerializeField, Tooltip("The hand that holds the stylus. The other one answers.")]
        private PenHand penHand = PenHand.Right;

        [SerializeField, Tooltip("The headset and how it is connected, for the log.")]
        private string headset = "";

        [SerializeField, Tooltip("Where the logs go. When it is empty, they go to the folder Studies in the player's " +
            "persistent data.")]
        private string folder = "";

        [SerializeField, Tooltip("Nobody takes part: this is a rehearsal, and logs and reports say so.")]
        private bool simulated;

        /// <summary>The order of the levels follows from it and the participant's number.</summary>
        public ulong Seed
        {
            get => seed;
            set => seed = value;
        }

        /// <summary>Delays in all, in ms.</summary>
        public IReadOnlyList<double> LevelsMilliseconds
        {
            get => levelsMilliseconds;
            set => levelsMilliseconds = value.ToArray();
        }

        /// <summary>Of the vibration, 20 to 500 Hz.</summary>
        public float ToneHertz => toneHertz;

        /// <summary>The vibration's peak, above 0 to 60 m/s^2.</summary>
        public float ToneMps2
        {
            get => toneMps2;
            set => toneMps2 = value;
        }

        /// <summary>In mm/s.</summary>
        public float MarkerSpeedMmps => markerSpeedMmps;

        /// <summary>Of the marker's circle.</summary>
        public float MarkerRadiusMillimetres => markerRadiusMillimetres;

        /// <summary>Between two stops of the marker.</summary>
        public float MoveSeconds
        {
            get => moveSeconds;
            set => moveSeconds = value;
        }

        /// <summary>Of a stop of the marker.</summary>
        public float RestSeconds
        {
            get => restSeconds;
            set => restSeconds = value;
        }

        /// <summary>How often the marker sets off and stops in a trial.</summary>
        public int Strokes
        {
            get => strokes;
            set => strokes = value;
        }

        /// <summary>From the audio callback to the hand.</summary>
        public float DeviceDelayMilliseconds
        {
            get => deviceDelayMilliseconds;
            set => deviceDelayMilliseconds = value;
        }

        /// <summary>Where that is known from.</summary>
        public DeviceDelaySource DeviceDelaySource
        {
            get => deviceDelaySource;
            set => deviceDelaySource = value;
        }

        /// <summary>How it was measured, or what the estimate rests on.</summary>
        public string DeviceDelayNote => deviceDelayNote;

        /// <summary>Of the audio device, from 0.</summary>
        public int HapticChannel
        {
            get => hapticChannel;
            set => hapticChannel = value;
        }

        /// <summary>What the headphones play.</summary>
        public NoiseColour NoiseColour => noiseColour;

        /// <summary>In dB of full scale.</summary>
        public float NoiseDecibels => noiseDecibels;

        /// <summary>The hand that holds the stylus.</summary>
        public PenHand PenHand => penHand;

        /// <summary>For the log.</summary>
        public string Headset => headset;

        /// <summary>Where the logs go; empty for the default.</summary>
        public string Folder
        {
            get => folder;
            set => folder = value;
        }

        /// <summary>Nobody takes part.</summary>
        public bool Simulated
        {
            get => simulated;
            set => simulated = value;
        }

        /// <summary>What a log says of them.</summary>
        public StudyFields Fields() => new StudyFields
        {
            { "levels_ms", levelsMilliseconds },
            { "tone", new StudyFields { { "frequency_hz", toneHertz }, { "amplitude_mps2", toneMps2 } } },
            {
                "marker", new StudyFields
                {
                    { "speed_mmps", markerSpeedMmps }, { "radius_mm", markerRadiusMillimetres },
                    { "move_seconds", moveSeconds }, { "rest_seconds", restSeconds }, { "strokes", strokes },
                }
            },
            {
                "motion", new StudyFields
                {
                    { "sets_off_mmps", 1000.0 * TrialContact.SetsOffMps },
                    { "rests_mmps", 1000.0 * TrialContact.RestsMps },
                }
            },
            { "haptic_channel", hapticChannel },
            {
                "noise", new StudyFields
                {
                    { "colour", noiseColour == NoiseColour.Pink ? "pink" : "white" }, { "level_db", noiseDecibels },
                }
            },
            { "pen_hand", penHand == PenHand.Left ? "left" : "right" },
        };

        /// <summary>Refuses a stop of the marker that ends before the longest delay can be noticed.</summary>
        /// <exception cref="StudyException">The message names the key.</exception>
        public void Check()
        {
            double needed = levelsMilliseconds.Length > 0 ? 0.001 * levelsMilliseconds.Max() + LongestStopSeconds : 0.0;
            if (restSeconds < needed || moveSeconds < needed)
            {
                throw new StudyException(string.Format(CultureInfo.InvariantCulture,
                    "{0}: rest_seconds is {1} and move_seconds {2}; expected at least {3} for both, the longest level " +
                    "and 0.2 s", name, restSeconds, moveSeconds, needed));
            }
        }
    }
}
