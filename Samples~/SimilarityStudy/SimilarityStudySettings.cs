#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>A similarity study: which materials, which methods, how the samples are mounted, what the set-up adds
    /// to the delay. One asset for all participants of a study.</summary>
    [CreateAssetMenu(menuName = "HaptoFlow/Similarity Study Settings", fileName = "SimilarityStudySettings")]
    public sealed class SimilarityStudySettings : ScriptableObject
    {
        [SerializeField, Tooltip("These are the real samples, any number of them. The first one is used for practice.")]
        private StudyMaterial[] materials = Array.Empty<StudyMaterial>();

        [SerializeField, Tooltip("These generate the vibration. There may be any number of them.")]
        private StudyMethod[] methods = Array.Empty<StudyMethod>();

        [SerializeField, Tooltip("The order of materials and methods follows from this number and the participant's. " +
            "It is the same for all participants of a study.")]
        private ulong seed = 1;

        [SerializeField, Tooltip("The logs go here. When it is empty, they go to the folder Studies in the player's " +
            "persistent data.")]
        private string folder = "";

        [SerializeField, Tooltip("This is how wide, high and deep the mounted samples are, in metres.")]
        private Vector3 sampleMetres = new Vector3(0.2f, 0.01f, 0.15f);

        [SerializeField, Tooltip("The virtual object lies this far from the real sample, from middle to middle, in " +
            "metres.")]
        private Vector3 virtualMetres = new Vector3(0.26f, 0f, 0f);

        [SerializeField, Range(0.002f, 0.03f), Tooltip("A tip that is no farther from an edge than this traces it, " +
            "in metres.")]
        private float edgeToleranceMetres = 0.012f;

        [SerializeField, Range(0.1f, 1f), Tooltip("This share of each edge has to be traced.")]
        private float edgeShare = 0.9f;

        [SerializeField, Range(0f, 0.01f), Tooltip("The tip counts as touching the real sample from this height on, " +
            "in metres. It makes up for what the tracking is off.")]
        private float realHeightMetres = 0.004f;

        [SerializeField, Tooltip("A blank plate lies under the virtual object. The force that a pen measures then " +
            "decides what it touches.")]
        private bool plateUnderVirtual = true;

        [SerializeField, Tooltip("The study begins only after the virtual object was aligned with the real sample.")]
        private bool needsAlignment = true;

        [SerializeField, Tooltip("The log calls the headset this.")]
        private string headset = "";

        [SerializeField, Tooltip("This hand holds the pen. The other one answers.")]
        private PenHand penHand = PenHand.Right;

        [SerializeField, Min(0), Tooltip("The actuator is wired to this channel of the audio device, counted from 0. " +
            "Every other channel gets the masking noise.")]
        private int hapticChannel = 1;

        [SerializeField, Tooltip("The headphones play this noise.")]
        private NoiseColour noiseColour = NoiseColour.White;

        [SerializeField, Range(MaskingNoise.LowestDecibels, MaskingNoise.HighestDecibels)]
        [Tooltip("The noise has this root mean square, in dB of full scale. The actuator must not be heard.")]
        private float noiseDecibels = -30f;

        [SerializeField, Min(0f), Tooltip("Every method gets this delay in all, in ms. 0 takes that of the slowest " +
            "method, measured before each session. Enter what was measured once, so that all participants have the " +
            "same.")]
        private float equalDelayMilliseconds;

        [SerializeField, Min(0f), Tooltip("This passes from the audio callback to the hand, in ms: in the buffers of " +
            "the audio device, the amplifier and the actuator. Software cannot measure it.")]
        private float deviceDelayMilliseconds = 20f;

        [SerializeField, Tooltip("Measured is what an oscilloscope or an accelerometer showed on this set-up. Logs " +
            "and reports name the source.")]
        private DeviceDelaySource deviceDelaySource = DeviceDelaySource.Estimated;

        [SerializeField, Tooltip("This says how and when the device delay was measured, or what the estimate rests " +
            "on.")]
        private string deviceDelayNote = "assumed by the sample, not measured on this set-up";

        [SerializeField, Tooltip("Nobody takes part: this is a rehearsal, and logs and reports say so.")]
        private bool simulated;

        /// <summary>The first is used for practice.</summary>
        public IReadOnlyList<StudyMaterial> Materials => materials;

        /// <summary>What generates the vibration.</summary>
        public IReadOnlyList<StudyMethod> Methods => methods;

        /// <summary>Shuffles the order.</summary>
        public ulong Seed
        {
            get => seed;
            set => seed = value;
        }

        /// <summary>Where the logs go.</summary>
        public string Folder
        {
            get => folder.Length > 0 ? folder : StudyPlayer.DefaultFolder;
            set => folder = value ?? "";
        }

        /// <summary>Width, height and depth, in metres.</summary>
        public Vector3 SampleMetres => sampleMetres;

        /// <summary>From the middle of the real sample to that of the virtual one, in metres.</summary>
        public Vector3 VirtualMetres => virtualMetres;

        /// <summary>A tip no farther from an edge traces it, in metres.</summary>
        public float EdgeToleranceMetres => edgeToleranceMetres;

        /// <summary>The share of each edge that has to be traced.</summary>
        public float EdgeShare => edgeShare;

        /// <summary>The tip counts as touching the real sample from this height on, in metres.</summary>
        public float RealHeightMetres => realHeightMetres;

        /// <summary>A blank plate lies under the virtual object.</summary>
        public bool PlateUnderVirtual => plateUnderVirtual;

        /// <summary>The study begins only after the alignment.</summary>
        public bool NeedsAlignment
        {
            get => needsAlignment;
            set => needsAlignment = value;
        }

        /// <summary>The name of the headset, for the log.</summary>
        public string Headset => headset;

        /// <summary>The hand that holds the pen.</summary>
        public PenHand PenHand => penHand;

        /// <summary>The output channel that the actuator is connected to; the first one is 0.</summary>
        public int HapticChannel => hapticChannel;

        /// <summary>The colour of the masking noise in the headphones.</summary>
        public NoiseColour NoiseColour => noiseColour;

        /// <summary>The RMS level of the masking noise, in dB of full scale.</summary>
        public float NoiseDecibels => noiseDecibels;

        /// <summary>The delay of every method, in ms; 0 for the delay of the slowest method.</summary>
        public float EqualDelayMilliseconds
        {
            get => equalDelayMilliseconds;
            set => equalDelayMilliseconds = value;
        }

        /// <summary>The delay from the audio callback to the hand, in ms.</summary>
        public float DeviceDelayMilliseconds => deviceDelayMilliseconds;

        /// <summary>Whether the device delay was measured or estimated.</summary>
        public DeviceDelaySource DeviceDelaySource => deviceDelaySource;

        /// <summary>How the device delay was measured, or what its estimate rests on.</summary>
        public string DeviceDelayNote => deviceDelayNote;

        /// <summary>Nobody takes part; logs and reports say so.</summary>
        public bool Simulated
        {
            get => simulated;
            set => simulated = value;
        }

        /// <summary>Chooses what is compared. Before the study's component wakes.</summary>
        public void Compare(IEnumerable<StudyMaterial> chosenMaterials, IEnumerable<StudyMethod> chosenMethods)
        {
            materials = chosenMaterials.ToArray();
            methods = chosenMethods.ToArray();
        }

        /// <summary>A participant's trials.</summary>
        /// <exception cref="StudyException">A name or the participant is unusable; the message names it.</exception>
        public StudyPlan PlanFor(int participant) => StudyPlan.Similarity(participant, seed,
            materials.Select(each => each.Name).ToArray(), methods.Select(each => each.Name).ToArray());

        /// <summary>Refuses what no study can run with, before anything is loaded.</summary>
        /// <exception cref="StudyException">The message names the setting and what to do.</exception>
        public void Check()
        {
            PlanFor(1);
            foreach (StudyMaterial each in materials)
            {
                Require(each.Material != null || each.Label.Trim().Length > 0, $"material \"{each.Name}\"",
                    "has neither a label nor a Haptic Material; choose one of them");
            }
            foreach (StudyMethod each in methods)
            {
                Require(each.Model != null, $"method \"{each.Name}\"",
                    "has no model; choose a .haptoflow asset in its field Model");
                Require(each.Quality != HapticQuality.Auto, $"method \"{each.Name}\"",
                    "has the quality Auto, which changes the tier while participants feel it; choose Draft, Standard " +
                    "or Fine");
            }
            float smallest = Mathf.Min(sampleMetres.x, sampleMetres.z);
            Require(smallest >= 0.02f && sampleMetres.y > 0f, "Sample Metres",
                "expected a width and depth of at least 0.02 and a height above 0");
            Require(edgeToleranceMetres > 0f && edgeToleranceMetres <= 0.25f * smallest, "Edge Tolerance Metres",
                "expected more than 0 and at most a quarter of the sample's shorter side, so that edges stay apart");
            Require(edgeShare > 0f && edgeShare <= 1f, "Edge Share", "expected more than 0 and at most 1");
            bool isApart = Mathf.Abs(virtualMetres.x) > sampleMetres.x || Mathf.Abs(virtualMetres.z) > sampleMetres.z;
            Require(isApart, "Virtual Metres", "the virtual object would overlap the real sample; move it aside by " +
                "more than the sample's width or depth");
            Require(hapticChannel >= 0, "Haptic Channel", "expected a channel from 0");
        }

        /// <summary>What the sidecar says of the settings.</summary>
        public StudyFields ForLog() => new StudyFields
        {
            { "materials", materials.Select(each => each.ForLog()).ToArray() },
            { "methods", methods.Select(each => new StudyFields
            {
                { "name", each.Name }, { "quality", each.Quality.ToString().ToLowerInvariant() },
            }).ToArray() },
            { "sample_metres", new[] { sampleMetres.x, sampleMetres.y, sampleMetres.z } },
            { "virtual_metres", new[] { virtualMetres.x, virtualMetres.y, virtualMetres.z } },
            { "edge_tolerance_metres", edgeToleranceMetres },
            { "edge_share", edgeShare },
            { "real_height_metres", realHeightMetres },
            { "plate_under_virtual", plateUnderVirtual },
            { "needs_alignment", needsAlignment },
            { "pen_hand", penHand == PenHand.Left ? "left" : "right" },
            { "haptic_channel", hapticChannel },
            {
                "noise", new StudyFields
                {
                    { "colour", noiseColour == NoiseColour.Pink ? "pink" : "white" }, { "level_db", noiseDecibels },
                }
            },
            { "equal_delay_ms", equalDelayMilliseconds },
        };

        private void Require(bool holds, string what, string expected)
        {
            if (!holds)
            {
                throw new StudyException($"{name}: {what}: {expected}");
            }
        }
    }
}
