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
}
