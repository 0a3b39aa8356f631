#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>The settings of a similarity study: the materials, the methods, how the samples are mounted, the
    /// delays. </summary>
    [CreateAssetMenu(menuName = "HaptoFlow/Similarity Study Settings", fileName = "SimilarityStudySettings")]
    public sealed class SimilarityStudySettings : StudySettings
    {
        [SerializeField, Tooltip("The materials are the real samples, any number of them. The first one is used for " +
            "practice.")]
        private StudyMaterial[] materials = Array.Empty<StudyMaterial>();

        [SerializeField, Tooltip("The methods generate the vibration. There may be any number of them.")]
        private StudyMethod[] methods = Array.Empty<StudyMethod>();

        [SerializeField, Tooltip("The mounted samples have this width, height and depth, in metres.")]
        private Vector3 sampleMetres = new Vector3(0.2f, 0.01f, 0.15f);

        [SerializeField, Tooltip("The virtual object lies this far from the real sample, from middle to middle, in " +
            "metres.")]
        private Vector3 virtualMetres = new Vector3(0.26f, 0f, 0f);

        [SerializeField, Range(0.002f, 0.03f), Tooltip("A tip traces an edge when it is no farther away than " +
            "this, in metres.")]
        private float edgeToleranceMetres = 0.012f;

        [SerializeField, Range(0.1f, 1f), Tooltip("The participant has to trace this share of each edge.")]
        private float edgeShare = 0.9f;

        [SerializeField, Range(0f, 0.01f), Tooltip("The tip counts as touching the real sample below this height " +
            "above it, in metres. The height makes up for errors of the tracking.")]
        private float realHeightMetres = 0.004f;

        [SerializeField, Tooltip("A blank plate lies under the virtual object. The force that a pen measures then " +
            "decides what it touches.")]
        private bool plateUnderVirtual = true;

        [SerializeField, Tooltip("The study begins only after the virtual object has been aligned with the real " +
            "sample.")]
        private bool needsAlignment = true;

        [SerializeField, Tooltip("This hand holds the pen. The other hand answers.")]
        private PenHand penHand = PenHand.Right;

        [SerializeField, Min(0f), Tooltip("Every method gets this total delay, in ms. With 0, every method gets " +
            "the delay of the slowest one, measured before each session. Enter a measured value, so that all " +
            "participants have the same delay.")]
        private float equalDelayMilliseconds;

        [SerializeField, Range(0.1f, 3f), Tooltip("Two methods count as equally similar when their ratings differ by " +
            "less than this, in points of the scale. Decide before the first participant; the log records it, and " +
            "the analysis tests against it.")]
        private float equivalencePoints = 0.5f;

        /// <summary>The real samples; the first one is used for practice.</summary>
        public IReadOnlyList<StudyMaterial> Materials => materials;

        /// <summary>The methods that generate the vibration.</summary>
        public IReadOnlyList<StudyMethod> Methods => methods;

        /// <summary>Width, height and depth of the mounted samples, in metres.</summary>
        public Vector3 SampleMetres => sampleMetres;

        /// <summary>From the middle of the real sample to that of the virtual one, in metres.</summary>
        public Vector3 VirtualMetres => virtualMetres;

        /// <summary>The largest distance from an edge at which the tip traces it, in metres.</summary>
        public float EdgeToleranceMetres => edgeToleranceMetres;

        /// <summary>The share of each edge that has to be traced.</summary>
        public float EdgeShare => edgeShare;

        /// <summary>The height below which the tip counts as touching the real sample, in metres.</summary>
        public float RealHeightMetres => realHeightMetres;

        /// <summary>Whether a blank plate lies under the virtual object.</summary>
        public bool PlateUnderVirtual => plateUnderVirtual;

        /// <summary>Whether the study begins only after the alignment.</summary>
        public bool NeedsAlignment { get => needsAlignment; set => needsAlignment = value; }

        /// <summary>The hand that holds the pen.</summary>
        public PenHand PenHand => penHand;

        /// <summary>The delay of every method, in ms; 0 for the delay of the slowest method.</summary>
        public float EqualDelayMilliseconds { get => equalDelayMilliseconds; set => equalDelayMilliseconds = value; }

        /// <summary>Ratings that differ by less count as equal, in points of the scale.</summary>
        public float EquivalencePoints => equivalencePoints;

        /// <summary>Sets materials and methods. Call it before the component of the scene wakes.</summary>
        public void Compare(IEnumerable<StudyMaterial> chosenMaterials, IEnumerable<StudyMethod> chosenMethods)
        {
            materials = chosenMaterials.ToArray();
            methods = chosenMethods.ToArray();
        }

        /// <summary>A participant's trials.</summary>
        /// <exception cref="StudyException">A name or the participant is unusable; the message names it.</exception>
        public StudyPlan PlanFor(int participant) => StudyPlan.Similarity(participant, Seed,
            materials.Select(each => each.Name).ToArray(), methods.Select(each => each.Name).ToArray());

        /// <summary>Refuses settings that no study can run with, before anything is loaded.</summary>
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
                    "has the quality Auto, which changes the tier while participants feel it; choose Sketch, " +
                    "Draft or Standard");
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
            Require(HapticChannel >= 0, "Haptic Channel", "expected a channel from 0");
        }

        /// <summary>The settings as the log holds them.</summary>
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
            { "haptic_channel", HapticChannel },
            { "noise", NoiseFields() },
            { "equal_delay_ms", equalDelayMilliseconds },
            { "equivalence_points", equivalencePoints },
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
