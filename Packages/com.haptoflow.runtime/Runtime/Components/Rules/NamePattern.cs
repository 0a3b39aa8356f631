#nullable enable
using HaptoFlow.Model;

namespace HaptoFlow
{
    /// <summary>Matches names against patterns in which <c>*</c> stands for any number of characters. Case is ignored.
    /// So is the form of accents: some systems write a name with them apart from their letters. Not by Regex, which
    /// allocates per match and interprets user text as a pattern language.</summary>
    internal static class NamePattern
    {
        /// <summary>True where the pattern matches the whole name; an empty pattern matches nothing.</summary>
        public static bool Matches(string pattern, string name)
        {
            pattern = LabelSpelling.Composed(pattern);
            name = LabelSpelling.Composed(name);
            int inPattern = 0;
            int inName = 0;
            int lastStar = -1;
            int resumeAt = 0;
            while (inName < name.Length)
            {
                if (inPattern < pattern.Length && pattern[inPattern] == '*')
                {
                    lastStar = inPattern++;
                    resumeAt = inName;
                }
                else if (inPattern < pattern.Length && IsSame(pattern[inPattern], name[inName]))
                {
                    ++inPattern;
                    ++inName;
                }
                else if (lastStar >= 0)
                {
                    // Backtrack: let the last star match one character more.
                    inPattern = lastStar + 1;
                    inName = ++resumeAt;
                }
                else
                {
                    return false;
                }
            }
            while (inPattern < pattern.Length && pattern[inPattern] == '*')
            {
                ++inPattern;
            }
            return pattern.Length > 0 && inPattern == pattern.Length;
        }

        private static bool IsSame(char first, char second) =>
            char.ToUpperInvariant(first) == char.ToUpperInvariant(second);
    }
}
