#nullable enable
using System;
using System.Collections.Generic;
using System.Text;

namespace HaptoFlow.Model
{
    /// <summary>Compares labels as every reader of HaptoFlow does: case and the form of accents (composed or not) do not
    /// matter, the language of the machine neither. Native code does the same, by the golden file Tests/Golden/labels.
    /// Any thread.</summary>
    public sealed class LabelSpelling : IEqualityComparer<string>
    {
        /// <summary>The one comparer.</summary>
        public static readonly LabelSpelling Same = new LabelSpelling();

        private LabelSpelling()
        {
        }

        /// <summary>True for two spellings of one label. Allocates only where one has letters beyond ASCII.</summary>
        public bool Equals(string? first, string? second) =>
            string.Equals(Key(first), Key(second), StringComparison.OrdinalIgnoreCase);

        /// <summary>The same number for all spellings of one label.</summary>
        public int GetHashCode(string label) => StringComparer.OrdinalIgnoreCase.GetHashCode(Key(label)!);

        /// <summary>The text with composed accents, for a comparison letter by letter; itself where all is ASCII.
        /// </summary>
        internal static string Composed(string text) => Normalized(text, NormalizationForm.FormC);

        // Mono, unlike .NET, has no capital for the sigma that ends a word.
        private static string? Key(string? label) =>
            label == null ? null : Normalized(label, NormalizationForm.FormD).Replace('\u03C2', '\u03C3');

        private static string Normalized(string text, NormalizationForm form)
        {
            try
            {
                return IsAscii(text) ? text : text.Normalize(form);
            }
            catch (ArgumentException)
            {
                // Half of a surrogate pair is no text; it is compared as it is.
                return text;
            }
        }

        private static bool IsAscii(string text)
        {
            foreach (char letter in text)
            {
                if (letter > '\x7F')
                {
                    return false;
                }
            }
            return true;
        }
    }
}
