#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow
{
    /// <summary>The labels of the loaded model: maps names to indices, and warns once about each name that the model
    /// does not have.</summary>
    internal sealed class ModelLabels
    {
        private readonly LabelNames names;
        private readonly double[] stiffness;
        private readonly HashSet<string> warned = new HashSet<string>(LabelSpelling.Same);

        public ModelLabels(IEnumerable<HapticLabel> labels)
        {
            HapticLabel[] all = labels.ToArray();
            names = new LabelNames(all.Select(label => label.Name));
            stiffness = all.Select(label => label.StiffnessNewtonsPerMetre).ToArray();
        }

        public IReadOnlyList<string> All => names.All;

        /// <summary>The learnt materials of the same engine; null without an engine.</summary>
        public LearntMaterials? Learnt { get; set; }

        /// <summary>The labels of a description with their weights, without unknown ones. The stiffness is the weighted
        /// mean of the labels' stiffness, 0 where no label is known.</summary>
        public LabelBlend Blend(
            MaterialDescription material, Object user, out double stiffnessNewtonsPerMetre)
        {
            LabelBlend blend = material.IsUnloaded ? default : Named(material, user);
            stiffnessNewtonsPerMetre = 0.0;
            for (int entry = 0; entry < blend.Count; ++entry)
            {
                stiffnessNewtonsPerMetre += blend.Weight(entry) * StiffnessOf(blend.Label(entry));
            }
            return blend;
        }

        private LabelBlend Named(MaterialDescription material, Object user)
        {
            int second = 0;
            bool knowsFirst = TryFindFirst(material, user, out int first);
            bool knowsSecond = material.SecondLabel.Length > 0 && TryFind(material.SecondLabel, user, out second);
            if (knowsFirst && knowsSecond)
            {
                return LabelBlend.Of(first, second, material.Blend);
            }
            return knowsFirst ? LabelBlend.Of(first) : knowsSecond ? LabelBlend.Of(second) : default;
        }

        /// <summary>A learnt material takes precedence over the label. While it is being registered, an unknown label
        /// causes no warning.</summary>
        private bool TryFindFirst(MaterialDescription material, Object user, out int index)
        {
            HapticMaterial? learnt = material.Learnt;
            bool isWaiting = false;
            if (learnt != null && Learnt != null && Learnt.TryFind(learnt, out index, out isWaiting))
            {
                return true;
            }
            return isWaiting ? names.TryFind(material.Label, out index) : TryFind(material.Label, user, out index);
        }

        private double StiffnessOf(int index) =>
            index < stiffness.Length ? stiffness[index] : Learnt!.StiffnessNewtonsPerMetre(index);

        private bool TryFind(string name, Object user, out int index)
        {
            if (names.TryFind(name, out index))
            {
                return true;
            }
            if (All.Count > 0 && warned.Add(name))
            {
                IReadOnlyList<string> near = names.NearMatches(name);
                string remedy = near.Count > 0
                    ? "near matches: " + string.Join(", ", near)
                    : "labels are: " + string.Join(", ", All);
                Debug.LogWarning(
                    $"HaptoFlow: the model has no label \"{name}\" (first used by {user.name}); {remedy}.", user);
            }
            return false;
        }
    }

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
