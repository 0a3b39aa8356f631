#nullable enable
using System;
using System.Text;
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>A real sample and what stands for it: a label of the models, or a Haptic Material.</summary>
    [Serializable]
    public sealed class StudyMaterial
    {
        [SerializeField, Tooltip("Logs and reports list the material under this name, and the operator mounts the " +
            "sample of this name.")]
        private string name = "";

        [SerializeField, Tooltip("This label of the models is felt, its texture alone. It counts where Material is " +
            "empty.")]
        private string label = "";

        [SerializeField, Tooltip("This Haptic Material is felt as its description says. It may have been learnt from " +
            "a recording.")]
        private HapticMaterial? material;

        /// <summary>For the asset's Inspector.</summary>
        public StudyMaterial()
        {
        }

        /// <summary>For programs.</summary>
        public StudyMaterial(string name, string label, HapticMaterial? material = null)
        {
            this.name = name;
            this.label = label;
            this.material = material;
        }

        /// <summary>In logs.</summary>
        public string Name => name;

        /// <summary>Counts where <see cref="Material"/> is null.</summary>
        public string Label => label;

        /// <summary>Null for the label alone.</summary>
        public HapticMaterial? Material => material;

        /// <summary>What the sidecar says of it: a session is gone on with the same or not at all.</summary>
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
}
