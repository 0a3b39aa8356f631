#nullable enable
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>What something feels like, and why, in words.</summary>
    internal static class FeltWords
    {
        /// <summary>What a tip feels: "wood", "wood 60 %, stone 40 %", "nothing".</summary>
        public static string Of(in HapticContact contact)
        {
            LabelBlend blend = contact.Labels;
            if (blend.Count == 0)
            {
                return "nothing";
            }
            return blend.Count == 1 ? NameOf(blend.Label(0)) : string.Join(", ", Enumerable.Range(0, blend.Count)
                .Select(entry => string.Format(CultureInfo.InvariantCulture, "{0} {1:0} %",
                    NameOf(blend.Label(entry)), 100f * blend.Weight(entry))));
        }

        /// <summary>What a description is: "wood", "wood and stone", with a remark where the model has no such label.
        /// </summary>
        public static string Of(MaterialDescription material)
        {
            LabelCatalog catalog = LabelCatalog.Current;
            string first = material.Learnt != null ? material.Learnt.name : catalog.TextOf(material.Label);
            return material.SecondLabel.Length == 0 ? first : first + " and " + catalog.TextOf(material.SecondLabel);
        }

        /// <summary>What an asset is: its name and its labels, one of them where both are the same.</summary>
        public static string Of(HapticMaterial? material)
        {
            if (material == null)
            {
                return "nothing";
            }
            string labels = Of(material.Description);
            return material.name == labels ? labels : $"{material.name} ({labels})";
        }

        /// <summary>What a part of a collider is, with its mask.</summary>
        public static string Of(in FeltPart part)
        {
            string material = Of(part.Material);
            return part.Mask is object ? $"{material}, masked by {part.Mask.name}" : material;
        }

        /// <summary>The first few names, and how many more there are.</summary>
        public static string Names(IReadOnlyCollection<Collider> colliders, int most)
        {
            string names = string.Join(", ", colliders.Take(most).Select(each => each.name));
            return colliders.Count <= most ? names : $"{names} and {colliders.Count - most} more";
        }

        private static string NameOf(int label)
        {
            HapticSession? session = HapticSession.Existing;
            IReadOnlyList<string> labels = Haptics.Labels;
            return label < labels.Count ? labels[label] : session?.Engine?.Material(label).Name ?? "";
        }
    }
}
