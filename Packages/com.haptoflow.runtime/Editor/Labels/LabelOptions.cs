#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Editor
{
    /// <summary>One line of a label's dropdown.</summary>
    internal readonly struct LabelOption
    {
        public LabelOption(string text, string label)
        {
            Text = text;
            Label = label;
        }

        public string Text { get; }

        /// <summary>What is chosen by it; empty for none.</summary>
        public string Label { get; }
    }

    /// <summary>What a label's dropdown offers.</summary>
    internal static class LabelOptions
    {
        /// <summary>The present name first where the model does not have it, then what it may have meant, then none
        /// where that is allowed, then all labels by name.</summary>
        public static IReadOnlyList<LabelOption> For(LabelCatalog catalog, string present, bool canBeEmpty)
        {
            var options = new List<LabelOption>();
            if (catalog.IsUnknown(present))
            {
                options.Add(new LabelOption(catalog.TextOf(present), present));
                options.AddRange(catalog.Names.NearMatches(present)
                    .Select(near => new LabelOption($"{near} (near \"{present}\")", near)));
            }
            if (canBeEmpty)
            {
                options.Add(new LabelOption(catalog.TextOf(""), ""));
            }
            options.AddRange(catalog.Names.All
                .OrderBy(name => name, StringComparer.OrdinalIgnoreCase)
                .Select(name => new LabelOption(name, name)));
            return options;
        }
    }
}
