#nullable enable
using System;
using System.Text;
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>A real sample and its virtual counterpart: a label of the models, or a Haptic Material.</summary>
    [Serializable]
    public sealed class StudyMaterial
    {
        [SerializeField, Tooltip("Logs and reports list the material under this name, and the operator mounts the " +
            "sample of this name.")]
        private string name = "";

        [SerializeField, Tooltip("The virtual object has the texture of this label, without other effects. The label " +
            "is used when Material is empty.")]
        private string label = "";

        [SerializeField, Tooltip("The virtual object feels as this Haptic Material describes. The material may have " +
            "been learnt from a recording.")]
        private HapticMaterial? material;

        /// <summary>Used by Unity's serialisation.</summary>
        public StudyMaterial()
        {
        }

        /// <summary>Creates a material from a script.</summary>
        public StudyMaterial(string name, string label, HapticMaterial? material = null) =>
            (this.name, this.label, this.material) = (name, label, material);

        /// <summary>The name in logs and reports.</summary>
        public string Name => name;

        /// <summary>The label of the models; used when <see cref="Material"/> is null.</summary>
        public string Label => label;

        /// <summary>The Haptic Material; null for the label alone.</summary>
        public HapticMaterial? Material => material;

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
}
