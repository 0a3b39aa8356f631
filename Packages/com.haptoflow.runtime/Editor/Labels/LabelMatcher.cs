#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;
using HaptoFlow.Model;

namespace HaptoFlow.Editor
{
    /// <summary>Proposes a label of the model from the name of an object or a physics material: for example wood for
    /// "Oak_Table".</summary>
    internal sealed class LabelMatcher
    {
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

        private string? FindName(string[] words)
        {
            for (int start = 0; start < words.Length; ++start)
            {
                foreach ((string label, string[] labelWords) in byLength)
                {
                    if (IsAt(words, start, labelWords))
                    {
                        return label;
                    }
                }
            }
            return null;
        }

        private static bool IsAt(string[] words, int start, string[] labelWords)
        {
            bool fits = start + labelWords.Length <= words.Length;
            for (int index = 0; fits && index < labelWords.Length; ++index)
            {
                fits = Forms(words[start + index]).Contains(labelWords[index]);
            }
            return fits;
        }

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
        private static IEnumerable<string> WordsOf(string name)
        {
            var word = new StringBuilder();
            for (int index = 0; index < name.Length; ++index)
            {
                char letter = name[index];
                bool startsWord = char.IsUpper(letter) && word.Length > 0 &&
                    (!char.IsUpper(name[index - 1]) || (index + 1 < name.Length && char.IsLower(name[index + 1])));
                if ((startsWord || !char.IsLetter(letter)) && word.Length > 0)
                {
                    yield return word.ToString();
                    word.Clear();
                }
                if (char.IsLetter(letter))
                {
                    word.Append(char.ToLowerInvariant(letter));
                }
            }
            if (word.Length > 0)
            {
                yield return word.ToString();
            }
        }
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
        public static IReadOnlyDictionary<string, string[]> All { get; } = ByWord();

        private static Dictionary<string, string[]> ByWord()
        {
            var all = new Dictionary<string, string[]>(StringComparer.Ordinal);
            foreach ((string labels, string words) in Groups)
            {
                string[] preferred = labels.Split(new[] { ", " }, StringSplitOptions.None);
                foreach (string word in words.Split(' '))
                {
                    all.Add(word, preferred);
                }
            }
            return all;
        }
    }
}
