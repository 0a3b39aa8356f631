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

        [SerializeField, Tooltip("This .haptoflow file generates: the package's model, or a rival that npm run " +
            "evaluate exports.")]
        private HapticModelAsset? model;

        [SerializeField, Tooltip("This tier of the model generates. Auto is refused, since it changes the tier while " +
            "participants feel it.")]
        private HapticQuality quality = HapticQuality.Standard;

        /// <summary>For the asset's Inspector.</summary>
        public StudyMethod()
        {
        }

        /// <summary>For programs.</summary>
        public StudyMethod(string name, HapticModelAsset? model, HapticQuality quality)
        {
            this.name = name;
            this.model = model;
            this.quality = quality;
        }

        /// <summary>In logs.</summary>
        public string Name => name;

        /// <summary>Null where none is chosen.</summary>
        public HapticModelAsset? Model => model;

        /// <summary>Which tier of the model generates.</summary>
        public HapticQuality Quality => quality;
    }
}
