#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow
{
    /// <summary>The material at one place: the part of a contact state that describes it.</summary>
    internal struct ResolvedMaterial
    {
        /// <summary>None where the place has no material.</summary>
        public LabelBlend Labels;

        /// <summary>Gain, 0 to 1.</summary>
        public float Strength;

        public float FeatureScale;

        public float ToneDbPerOctave;

        /// <summary>Of the object, not of its material.</summary>
        public float Variation;

        public HapticEffects Effects;

        /// <summary>Stiffness in N/m; 0 for the contact model's default.</summary>
        public double StiffnessNewtonsPerMetre;

        /// <summary>Description of the material with the largest weight; null where the place has none.</summary>
        public MaterialDescription? Heaviest;

        /// <summary>The submesh or terrain layer with the largest weight.</summary>
        public int Part;

        /// <summary>The material under a hand whose metre is another than the world's: its features keep their size in
        /// the world, as far as the engine can scale them.</summary>
        /// <param name="scale">Metres of the world for a metre of the hand.</param>
        public ResolvedMaterial On(double scale)
        {
            ResolvedMaterial material = this;
            material.FeatureScale = scale == 1.0
                ? FeatureScale
                : (float)Vectors.Clamp(FeatureScale / scale, MaterialDescription.MinimumFeatureScale,
                    MaterialDescription.MaximumFeatureScale);
            return material;
        }

        /// <summary>A single material.</summary>
        public static ResolvedMaterial Of(MaterialDescription description, MaterialLookUp lookUp) => new ResolvedMaterial
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
