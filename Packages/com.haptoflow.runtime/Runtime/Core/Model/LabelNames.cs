#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Model
{
    /// <summary>Finds labels by name, and what a misspelt name may have meant.</summary>
    public sealed class LabelNames
    {
        private readonly Dictionary<string, int> indices =
            new Dictionary<string, int>(StringComparer.OrdinalIgnoreCase);
        private readonly string[] names;

        /// <summary>In the order of their indices.</summary>
        public LabelNames(IEnumerable<string> labels)
        {
            names = labels.ToArray();
            for (int index = 0; index < names.Length; ++index)
            {
                indices[names[index]] = index;
            }
        }

        /// <summary>In the order of their indices.</summary>
        public IReadOnlyList<string> All => names;

        /// <summary>Upper and lower case count the same.</summary>
        public bool TryFind(string name, out int index) => indices.TryGetValue(name, out index);

        /// <summary>Names within two letters of this one, or that hold it or are held by it; the nearest first.
        /// </summary>
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

        /// <summary>Letters to insert, delete or replace (Levenshtein 1966).</summary>
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
