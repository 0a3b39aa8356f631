#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>The settings of a similarity study: the materials, the methods, how the samples are mounted, the
    /// delays. </summary>
    [CreateAssetMenu(menuName = "HaptoFlow/Similarity Study Settings", fileName = "SimilarityStudySettings")]
    public sealed class SimilarityStudySettings : StudySettings
    {
        [Tooltip("The materials are the real samples, any number of them. The first one is used for " +
            "practice.")]
        public StudyMaterial[] materials = Array.Empty<StudyMaterial>();

        [Tooltip("The methods generate the vibration. There may be any number of them.")]
        public StudyMethod[] methods = Array.Empty<StudyMethod>();

        [Tooltip("The mounted samples have this width, height and depth, in metres.")]
        public Vector3 sampleMetres = new Vector3(0.2f, 0.01f, 0.15f);

        [Tooltip("The virtual object lies this far from the real sample, from middle to middle, in " +
            "metres.")]
        public Vector3 virtualMetres = new Vector3(0.26f, 0f, 0f);

        [Range(0.002f, 0.03f), Tooltip("A tip traces an edge when it is no farther away than " +
            "this, in metres.")]
        public float edgeToleranceMetres = 0.012f;

        [Range(0.1f, 1f), Tooltip("The participant has to trace this share of each edge.")]
        public float edgeShare = 0.9f;

        [Range(0f, 0.01f), Tooltip("The tip counts as touching the real sample below this height " +
            "above it, in metres. The height makes up for errors of the tracking.")]
        public float realHeightMetres = 0.004f;

        [Tooltip("A blank plate lies under the virtual object. The force that a pen measures then " +
            "decides what it touches.")]
        public bool plateUnderVirtual = true;

        [Tooltip("The study begins only after the virtual object has been aligned with the real " +
            "sample.")]
        public bool needsAlignment = true;

        [Tooltip("This hand holds the pen. The other hand answers.")]
        public PenHand penHand = PenHand.Right;

        [Min(0f), Tooltip("Every method gets this total delay, in ms. With 0, every method gets " +
            "the delay of the slowest one, measured before each session. Enter a measured value, so that all " +
            "participants have the same delay.")]
        public float equalDelayMilliseconds;

        [Range(0.1f, 3f), Tooltip("Two methods count as equally similar when their ratings differ by " +
            "less than this, in points of the scale. Decide before the first participant; the log records it, and " +
            "the analysis tests against it.")]
        public float equivalencePoints = 0.5f;

        /// <exception cref="StudyException">A name or the participant is unusable; the message names it.</exception>
        public StudyPlan PlanFor(int participant) => StudyPlan.Similarity(participant, Seed,
            materials.Select(each => each.name).ToArray(), methods.Select(each => each.name).ToArray());

        /// <summary>Refuses settings that no study can run with, before anything is loaded.</summary>
        /// <exception cref="StudyException">The message names the setting and what to do.</exception>
        public void Check()
        {
            PlanFor(1);
            foreach (StudyMaterial each in materials)
            {
                Require(each.material != null || each.label.Trim().Length > 0, $"material \"{each.name}\"",
                    "has neither a label nor a Haptic Material; choose one of them");
            }
            foreach (StudyMethod each in methods)
            {
                Require(each.model != null, $"method \"{each.name}\"",
                    "has no model; choose a .haptoflow asset in its field Model");
                Require(each.Quality != HapticQuality.Auto, $"method \"{each.name}\"",
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

        public StudyFields ForLog() => new StudyFields
        {
            { "materials", materials.Select(each => each.ForLog()).ToArray() },
            { "methods", methods.Select(each => new StudyFields
            {
                { "name", each.name }, { "quality", each.Quality.ToString().ToLowerInvariant() },
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

    /// <summary>A real sample and its virtual counterpart: a label of the models, or a Haptic Material.</summary>
    [Serializable]
    public sealed class StudyMaterial
    {
        [Tooltip("Logs and reports list the material under this name, and the operator mounts the " +
            "sample of this name.")]
        public string name = "";

        [Tooltip("The virtual object has the texture of this label, without other effects. The label " +
            "is used when Material is empty.")]
        public string label = "";

        [Tooltip("The virtual object feels as this Haptic Material describes. The material may have " +
            "been learnt from a recording.")]
        public HapticMaterial? material;

        /// <summary>The material as the log holds it. A session can be resumed only with the same material.</summary>
        public StudyFields ForLog()
        {
            var fields = new StudyFields { { "name", name } };
            if (material == null)
            {
                fields.Add("label", label);
                return fields;
            }
            MaterialDescription felt = material.Description;
            fields.Add("label", felt.Label);
            fields.Add("second_label", felt.SecondLabel);
            fields.Add("blend", felt.Blend);
            fields.Add("stiffness_newtons_per_metre", felt.StiffnessNewtonsPerMetre);
            fields.Add("strength", felt.Strength);
            fields.Add("feature_scale", felt.FeatureScale);
            fields.Add("tone_db_per_octave", felt.ToneDbPerOctave);
            fields.Add("effects", felt.Effects.ToString().ToLowerInvariant());
            fields.Add("learnt_sha256", material.IsLearnt ? Hash.Sha256(Encoding.UTF8.GetBytes(material.Learnt)) : "");
            return fields;
        }
    }

    /// <summary>A way to generate the vibration: a model, or one tier of it, under a name.</summary>
    [Serializable]
    public sealed class StudyMethod
    {
        [Tooltip("Logs and reports list the method under this name, for example ours or DSTN.")]
        public string name = "";

        [Tooltip("The vibration comes from this .haptoflow file: the package's model, or a rival " +
            "that npm run evaluate exports.")]
        public HapticModelAsset? model;

        [Tooltip("The vibration comes from this tier of the model. Auto is refused, because it " +
            "changes the tier while participants feel it.")]
        public HapticQuality quality = HapticQuality.Standard;

        public HapticQuality Quality => quality.OrStandard();
    }
}
