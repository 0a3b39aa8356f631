#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;
using HaptoFlow.Model;

namespace HaptoFlow.Editor
{
    /// <summary>Guesses a label from the name of an object or a physics material: "Oak_Table" is wood where the model
    /// has wood. Proposes nothing but labels of the model.</summary>
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

        /// <summary>A label's own name counts before words that mean it, an earlier word before a later one, and
        /// "metal mesh" before "metal". Null where nothing fits.</summary>
        public string? Propose(string name)
        {
            string[] words = WordsOf(name).ToArray();
            return Named(words) ?? words.Select(Meant).FirstOrDefault(label => label != null);
        }

        private string? Named(string[] words)
        {
            for (int start = 0; start < words.Length; ++start)
            {
                foreach ((string label, string[] wanted) in byLength)
                {
                    if (IsAt(words, start, wanted))
                    {
                        return label;
                    }
                }
            }
            return null;
        }

        private static bool IsAt(string[] words, int start, string[] wanted)
        {
            bool fits = start + wanted.Length <= words.Length;
            for (int index = 0; fits && index < wanted.Length; ++index)
            {
                fits = Forms(words[start + index]).Contains(wanted[index]);
            }
            return fits;
        }

        private string? Meant(string word)
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

        /// <summary>The word, and what it may be the plural of.</summary>
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

        /// <summary>"OakTable_02" is oak, table: words end at anything that is no letter and at capitals.</summary>
        private static IEnumerable<string> WordsOf(string name)
        {
            var word = new StringBuilder();
            for (int index = 0; index < name.Length; ++index)
            {
                char letter = name[index];
                bool begins = char.IsUpper(letter) && word.Length > 0 &&
                    (!char.IsUpper(name[index - 1]) || (index + 1 < name.Length && char.IsLower(name[index + 1])));
                if ((begins || !char.IsLetter(letter)) && word.Length > 0)
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
}
