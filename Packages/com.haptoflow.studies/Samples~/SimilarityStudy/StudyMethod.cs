#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>A way to generate the vibration: a model, or one tier of it, under a name.</summary>
    [Serializable]
    public sealed class StudyMethod
    {
        [SerializeField, Tooltip("Logs and reports list the method under this name, for example ours or DSTN.")]
        private string name = "";

        [SerializeField, Tooltip("The vibration comes from this .haptoflow file: the package's model, or a rival " +
            "that npm run evaluate exports.")]
        private HapticModelAsset? model;

        [SerializeField, Tooltip("The vibration comes from this tier of the model. Auto is refused, because it " +
            "changes the tier while participants feel it.")]
        private HapticQuality quality = HapticQuality.Standard;

        /// <summary>Used by Unity's serialisation.</summary>
        public StudyMethod()
        {
        }

        /// <summary>Creates a method from a script.</summary>
        public StudyMethod(string name, HapticModelAsset? model, HapticQuality quality) =>
            (this.name, this.model, this.quality) = (name, model, quality);

        /// <summary>The name in logs and reports.</summary>
        public string Name => name;

        /// <summary>The model; null when none is chosen.</summary>
        public HapticModelAsset? Model => model;

        /// <summary>The quality, which chooses the tier of the model.</summary>
        public HapticQuality Quality => quality.OrStandard();
    }
}
