#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.Model;

namespace HaptoFlow.Editor
{
    /// <summary>Proposes a label of the model from the name of an object or a physics material: for example wood for
    /// "Oak_Table".</summary>
    internal sealed class LabelMatcher
    {
        // Capitals before a capitalised word, a word with at most one capital, capitals.
        private static readonly Regex Word =
            new Regex(@"\p{Lu}+(?=\p{Lu}\p{Ll})|\p{Lu}?[\p{L}-[\p{Lu}]]+|\p{Lu}+", RegexOptions.CultureInvariant);

        private readonly LabelNames labels;
        private readonly (string Label, string[] Words)[] byLength;

        public LabelMatcher(LabelNames labels)
        {
            this.labels = labels;
            byLength = labels.All
                .Select(label => (label, words: WordsOf(label).ToArray()))
                .Where(entry => entry.words.Length > 0)
                .OrderByDescending(entry => entry.words.Length)
                .ToArray();
        }

        /// <summary>The label that a name suggests; null without one. The name of a label takes precedence over a
        /// synonym, an earlier word over a later one, and "metal mesh" over "metal".</summary>
        public string? Propose(string name)
        {
            string[] words = WordsOf(name).ToArray();
            return FindName(words) ?? words.Select(FindSynonym).FirstOrDefault(label => label != null);
        }

        private string? FindName(string[] words) => Enumerable.Range(0, words.Length)
            .SelectMany(start => byLength.Where(entry => IsAt(words, start, entry.Words)))
            .Select(entry => entry.Label).FirstOrDefault();

        private static bool IsAt(string[] words, int start, string[] labelWords) =>
            start + labelWords.Length <= words.Length &&
            labelWords.Zip(words.Skip(start), (wanted, word) => Forms(word).Contains(wanted)).All(fits => fits);

        private string? FindSynonym(string word)
        {
            foreach (string form in Forms(word))
            {
                if (LabelWords.All.TryGetValue(form, out string[] preferred))
                {
                    return preferred.Select(InModel).FirstOrDefault(label => label != null);
                }
            }
            return null;
        }

        private string? InModel(string label) => labels.TryFind(label, out int index) ? labels.All[index] : null;

        /// <summary>The word itself, and its possible singular forms.</summary>
        private static IEnumerable<string> Forms(string word)
        {
            yield return word;
            if (word.Length > 3 && word.EndsWith("s", StringComparison.Ordinal))
            {
                yield return word.Substring(0, word.Length - 1);
            }
            if (word.Length > 4 && word.EndsWith("es", StringComparison.Ordinal))
            {
                yield return word.Substring(0, word.Length - 2);
            }
        }

        /// <summary>Splits a name into words at capitals and at characters that are no letters: "OakTable_02" into oak
        /// and table.</summary>
        private static IEnumerable<string> WordsOf(string name) =>
            Word.Matches(name).Cast<Match>().Select(word => word.Value.ToLowerInvariant());
    }

    /// <summary>Synonyms for materials, each with the labels that fit it, the best first. Words that often mean
    /// something else in the name of an object, such as "mesh" and "mat", are left out.</summary>
    internal static class LabelWords
    {
        private static readonly (string Labels, string Words)[] Groups =
        {
            ("wood", "oak pine walnut birch maple mahogany cedar beech teak spruce bamboo timber lumber plank wooden " +
                "parquet hardwood log"),
            ("plywood, wood", "ply mdf osb chipboard particleboard fibreboard fiberboard hardboard"),
            ("stone", "rock marble granite slate limestone sandstone cobble cobblestone pebble boulder basalt " +
                "travertine"),
            ("concrete, stone", "cement asphalt tarmac plaster stucco mortar"),
            ("brick, stone", "clinker masonry"),
            ("ceramic, glass", "porcelain tile earthenware terracotta pottery stoneware faience"),
            ("glass, ceramic", "crystal mirror window windshield"),
            ("metal", "steel iron aluminium aluminum brass copper bronze chrome titanium zinc nickel tin gold silver " +
                "metallic alloy"),
            ("metal mesh, metal", "grate grating grille chainlink wiremesh"),
            ("plastic", "acrylic pvc vinyl polymer plexiglass polycarbonate bakelite melamine laminate"),
            ("rubber, plastic", "silicone latex neoprene tyre tire eraser"),
            ("leather", "suede leatherette cowhide"),
            ("cotton", "cloth fabric linen textile canvas denim silk polyester wool curtain towel"),
            ("corduroy, cotton", "velvet velour"),
            ("jute, cotton", "burlap hessian sackcloth sisal hemp rope"),
            ("fur, carpet", "pelt plush fleece furry fluffy"),
            ("paper, cardboard", "newspaper parchment poster"),
            ("cardboard, paper", "carton paperboard corrugated"),
            ("sandpaper, stone", "emery abrasive"),
            ("carpet, cotton", "rug doormat tatami moquette"),
        };

        /// <summary>The labels for a word in lower case, in order of preference.</summary>
        public static IReadOnlyDictionary<string, string[]> All { get; } = Groups
            .SelectMany(group => group.Words.Split(' '), (group, word) => (word, labels: group.Labels.Split(", ")))
            .ToDictionary(entry => entry.word, entry => entry.labels, StringComparer.Ordinal);
    }
}
