#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>What a description means to the running engine, looked up again only when the description or the
    /// model's labels changed. Main thread; no garbage while nothing changes.</summary>
    internal sealed class MaterialLookUp
    {
        private MaterialDescription? knownDescription;
        private int knownVersion;
        private int knownLabels;
        private double labelStiffness;

        /// <summary>None where the model knows no label of the description.</summary>
        public LabelBlend Labels { get; private set; }

        /// <summary>In N/m, of the description, else of the labels; 0 for the contact model's default.</summary>
        public double StiffnessNewtonsPerMetre
        {
            get
            {
                float described = knownDescription?.StiffnessNewtonsPerMetre ?? 0f;
                return described > 0f ? described : labelStiffness;
            }
        }

        /// <param name="user">Who is named where the model does not know a label.</param>
        /// <returns>This.</returns>
        public MaterialLookUp Of(MaterialDescription description, HapticSession session, Object user)
        {
            bool isKnown = ReferenceEquals(description, knownDescription) && description.Version == knownVersion &&
                session.LabelsVersion == knownLabels;
            if (!isKnown)
            {
                knownDescription = description;
                knownVersion = description.Version;
                knownLabels = session.LabelsVersion;
                Labels = session.Labels.Blend(description, user, out labelStiffness);
            }
            return this;
        }
    }
}
