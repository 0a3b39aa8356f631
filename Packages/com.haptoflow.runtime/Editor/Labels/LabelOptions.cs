#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Editor
{
    /// <summary>An entry in the dropdown list of a label.</summary>
    /// <param name="Label">The label that the entry chooses; empty for none.</param>
    internal sealed record LabelOption(string Text, string Label);

    /// <summary>The entries in the dropdown list of a label.</summary>
    internal static class LabelOptions
    {
        /// <summary>The entries in this order: the current name if the model does not have it, labels with similar
        /// names, none if that is allowed, and all labels sorted by name.</summary>
        public static IReadOnlyList<LabelOption> For(LabelCatalog catalog, string current, bool canBeEmpty)
        {
            var options = new List<LabelOption>();
            if (catalog.IsUnknown(current))
            {
                options.Add(new LabelOption(catalog.TextOf(current), current));
                options.AddRange(catalog.Names.NearMatches(current)
                    .Select(near => new LabelOption($"{near} (near \"{current}\")", near)));
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
