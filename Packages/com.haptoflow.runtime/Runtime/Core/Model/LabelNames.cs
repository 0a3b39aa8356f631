#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Model
{
    /// <summary>Finds labels by name, and suggests labels for a misspelt name.</summary>
    public sealed class LabelNames
    {
        private const int RememberedSpellings = 1024;

        private readonly Dictionary<string, int> indices = new Dictionary<string, int>(LabelSpelling.Same);

        // Spellings that were asked for: a surface asks each frame, and a comparison beyond ASCII allocates.
        private readonly Dictionary<string, int> asked = new Dictionary<string, int>(StringComparer.Ordinal);
        private readonly string[] names;

        /// <param name="labels">Names in the order of their indices.</param>
        public LabelNames(IEnumerable<string> labels)
        {
            names = labels.ToArray();
            for (int index = 0; index < names.Length; ++index)
            {
                indices[names[index]] = index;
            }
        }

        /// <summary>Names in the order of their indices.</summary>
        public IReadOnlyList<string> All => names;

        /// <summary>Finds the index of a name; case and the form of accents are ignored (<see cref="LabelSpelling"/>).
        /// One thread at a time.</summary>
        public bool TryFind(string name, out int index)
        {
            if (!asked.TryGetValue(name, out index))
            {
                index = indices.TryGetValue(name, out int found) ? found : -1;
                if (asked.Count < RememberedSpellings)
                {
                    asked[name] = index;
                }
            }
            bool isKnown = index >= 0;
            index = Math.Max(index, 0);
            return isKnown;
        }

        /// <summary>Up to three labels with at most two different letters, or of which one name contains the other, in
        /// order of similarity.</summary>
        public IReadOnlyList<string> NearMatches(string name)
        {
            string wanted = name.Trim().ToLowerInvariant();
            return names
                .Select(label => (label, distance: Distance(wanted, label.ToLowerInvariant())))
                .Where(match => match.distance <= 2 || Holds(wanted, match.label.ToLowerInvariant()))
                .OrderBy(match => match.distance)
                .ThenBy(match => match.label, StringComparer.Ordinal)
                .Select(match => match.label)
                .Take(3)
                .ToArray();
        }

        private static bool Holds(string wanted, string label) =>
            wanted.Length >= 3 && (label.Contains(wanted) || wanted.Contains(label));

        /// <summary>Edit distance: letters to insert, delete or replace (Levenshtein 1966); .NET has none.</summary>
        private static int Distance(string a, string b)
        {
            int[] row = Enumerable.Range(0, b.Length + 1).ToArray();
            for (int i = 1; i <= a.Length; ++i)
            {
                int diagonal = row[0];
                row[0] = i;
                for (int j = 1; j <= b.Length; ++j)
                {
                    int above = row[j];
                    int replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
                    row[j] = Math.Min(Math.Min(above, row[j - 1]) + 1, replaced);
                    diagonal = above;
                }
            }
            return row[b.Length];
        }
    }
}
