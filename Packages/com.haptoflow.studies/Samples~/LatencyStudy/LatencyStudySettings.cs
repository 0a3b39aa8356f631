#nullable enable
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>Everything that a laboratory decides about the study. An interrupted session can be resumed only with
    /// the settings that it was begun with.</summary>
    [CreateAssetMenu(menuName = "HaptoFlow/Latency Study Settings", fileName = "LatencyStudySettings")]
    public sealed class LatencyStudySettings : StudySettings
    {
        // The marker has to stop and move for longer than the longest delay, by this.
        private const double ReserveSeconds = 0.2;

        [Tooltip("The levels are the delays between pen and vibration, in ms. Each may be listed " +
            "once.")]
        public double[] levelsMilliseconds = { 50, 70, 90, 110, 130, 150, 170, 190, 210, 230, 250 };

        [Range((float)HapticVoice.MinimumSignalHz, (float)HapticVoice.MaximumSignalHz)]
        [Tooltip("The vibration is a sine of this frequency, in Hz.")]
        public float toneHertz = 200f;

        [Range(0.1f, (float)HapticVoice.MaximumSignalMps2)]
        [Tooltip("The vibration has this peak, in m/s^2. Set the level at the amplifier, and leave this value the " +
            "same for all participants.")]
        public float toneMps2 = 20f;

        [Min(1f), Tooltip("The marker moves at this speed, in mm/s.")]
        public float markerSpeedMmps = 150f;

        [Range(20f, 100f), Tooltip("The marker moves on a circle of this radius, in mm.")]
        public float markerRadiusMillimetres = 60f;

        [Min(0.2f), Tooltip("The marker moves for this time between two stops, in s. It has " +
            "to be longer than the longest level by 0.2 s.")]
        public float moveSeconds = 1.5f;

        [Min(0.2f), Tooltip("The marker stops for this time, in s. It has to be longer than " +
            "the longest level by 0.2 s.")]
        public float restSeconds = 1f;

        [Range(1, 20), Tooltip("The marker sets off and stops this often in a trial.")]
        public int strokes = 3;

        [Tooltip("This hand holds the pen. The other hand answers.")]
        public PenHand penHand = PenHand.Right;

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
                    { "sets_off_mmps", 1000.0 * TrialContact.StartSpeedMps },
                    { "rests_mmps", 1000.0 * TrialContact.StopSpeedMps },
                }
            },
            { "haptic_channel", HapticChannel },
            { "noise", NoiseFields() },
            { "pen_hand", penHand == PenHand.Left ? "left" : "right" },
        };

        /// <summary>Refuses a marker that stops or moves for too short a time to notice the longest delay.</summary>
        /// <exception cref="StudyException">The message names the key.</exception>
        public void Check()
        {
            double needed = levelsMilliseconds.Length > 0 ? 0.001 * levelsMilliseconds.Max() + ReserveSeconds : 0.0;
            if (restSeconds < needed || moveSeconds < needed)
            {
                throw new StudyException(string.Format(CultureInfo.InvariantCulture,
                    "{0}: rest_seconds is {1} and move_seconds {2}; expected at least {3} for both, the longest level " +
                    "and 0.2 s", name, restSeconds, moveSeconds, needed));
            }
        }
    }
}
