#nullable enable
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Describes in words what something feels like.</summary>
    internal static class MaterialWords
    {
        private const int MaximumNames = 8;

        /// <summary>The labels of a contact: "wood", "wood 60 %, stone 40 %", "nothing".</summary>
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

        /// <summary>The labels of a description: "wood" or "wood and stone", with a remark for a label that the model
        /// does not have. </summary>
        public static string Of(MaterialDescription material)
        {
            LabelCatalog catalog = LabelCatalog.Current;
            string first = material.Learnt != null ? material.Learnt.name : catalog.TextOf(material.Label);
            return material.SecondLabel.Length == 0 ? first : first + " and " + catalog.TextOf(material.SecondLabel);
        }

        /// <summary>The name and the labels of an asset, or just the name when both are the same.</summary>
        public static string Of(HapticMaterial? material)
        {
            if (material == null)
            {
                return "nothing";
            }
            string labels = Of(material.Description);
            return material.name == labels ? labels : $"{material.name} ({labels})";
        }

        /// <summary>The material of a part of a collider, with its mask.</summary>
        public static string Of(in MappedPart part)
        {
            string material = Of(part.Material);
            return part.Mask is object ? $"{material}, masked by {part.Mask.name}" : material;
        }

        /// <summary>The first few names, and how many more there are.</summary>
        public static string Names(IReadOnlyCollection<Object> objects, int maximum = MaximumNames)
        {
            string names = string.Join(", ", objects.Take(maximum).Select(each => each.name));
            return objects.Count <= maximum ? names : $"{names} and {objects.Count - maximum} more";
        }

        private static string NameOf(int label)
        {
            HapticSession? session = HapticSession.Existing;
            IReadOnlyList<string> labels = Haptics.Labels;
            return label < labels.Count ? labels[label] : session?.Engine?.Material(label).Name ?? "";
        }
    }
}
