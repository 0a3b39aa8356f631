#nullable enable
using NUnit.Framework;

namespace HaptoFlow.Tests
{
    public sealed class NamePatternTests
    {
        [TestCase("Floor", "Floor")]
        [TestCase("floor", "FLOOR")]
        [TestCase("*", "")]
        [TestCase("*", "anything")]
        [TestCase("Rug*", "Rug(Clone)")]
        [TestCase("*rug*", "Old Rug (1)")]
        [TestCase("a*b*c", "aXbYbZc")]
        [TestCase("**a", "a")]
        [TestCase("*ab", "aaab")]
        public void APatternMatchesAName(string pattern, string name) =>
            Assert.That(NamePattern.Matches(pattern, name), Is.True);

        [TestCase("", "")]
        [TestCase("", "Floor")]
        [TestCase("Floor", "Floor 2")]
        [TestCase("Floor", "The Floor")]
        [TestCase("*rug", "rug (1)")]
        [TestCase("a*b*c", "acb")]
        [TestCase("*ab", "aba")]
        public void APatternDoesNotMatchOtherNames(string pattern, string name) =>
            Assert.That(NamePattern.Matches(pattern, name), Is.False);
    }
}
