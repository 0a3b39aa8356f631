#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Resolves a description to labels of the running engine, again only after the description or the
    /// model's labels changed, and to none once its asset was unloaded. Main thread; no garbage while nothing
    /// changes.</summary>
    internal sealed class MaterialLookUp
    {
        private MaterialDescription? knownDescription;
        private int knownVersion;
        private int knownLabels;
        private bool knownUnloaded;
        private double labelStiffness;

        /// <summary>The labels with their weights; none where the model knows no label of the description.</summary>
        public LabelBlend Labels { get; private set; }

        /// <summary>Stiffness in N/m, of the description, else of the labels; 0 for the contact model's
        /// default.</summary>
        public double StiffnessNewtonsPerMetre
        {
            get
            {
                float described = knownDescription?.StiffnessNewtonsPerMetre ?? 0f;
                return described > 0f ? described : labelStiffness;
            }
        }

        /// <param name="user">Object that a warning about an unknown label names.</param>
        /// <returns>This object.</returns>
        public MaterialLookUp Of(MaterialDescription description, HapticSession session, Object user)
        {
            bool isUnloaded = description.IsUnloaded;
            bool isKnown = ReferenceEquals(description, knownDescription) && description.Version == knownVersion &&
                session.LabelsVersion == knownLabels && isUnloaded == knownUnloaded;
            if (!isKnown)
            {
                if (isUnloaded && !knownUnloaded)
                {
                    Debug.LogWarning($"HaptoFlow: {user.name} is no longer felt: its Haptic Material (label " +
                        $"\"{description.Label}\") was unloaded. Assign it again, or keep the asset loaded.", user);
                }
                knownUnloaded = isUnloaded;
                knownDescription = description;
                knownVersion = description.Version;
                knownLabels = session.LabelsVersion;
                Labels = session.Labels.Blend(description, user, out labelStiffness);
            }
            return this;
        }
    }
}
