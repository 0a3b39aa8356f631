#nullable enable

namespace HaptoFlow
{
    /// <summary>What is felt at one place: everything that a contact state says of the material.</summary>
    internal struct FeltMaterial
    {
        /// <summary>None where nothing is felt.</summary>
        public LabelBlend Labels;

        /// <summary>0 to 1.</summary>
        public float Strength;

        public float FeatureScale;

        public float ToneDbPerOctave;

        public HapticEffects Effects;

        /// <summary>0 for the contact model's default.</summary>
        public double StiffnessNewtonsPerMetre;

        /// <summary>Of the material with the most weight; null where nothing is felt.</summary>
        public MaterialDescription? Heaviest;

        /// <summary>The submesh or terrain layer with the most weight.</summary>
        public int Part;

        /// <summary>One material alone.</summary>
        public static FeltMaterial Of(MaterialDescription description, MaterialLookUp lookUp) => new FeltMaterial
        {
            Labels = lookUp.Labels,
            Strength = description.Strength,
            FeatureScale = description.FeatureScale,
            ToneDbPerOctave = description.ToneDbPerOctave,
            Effects = description.Effects,
            StiffnessNewtonsPerMetre = lookUp.StiffnessNewtonsPerMetre,
            Heaviest = description,
        };
    }
}
