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
        [TestCase("*\u00e4hre*", "Alte A\u0308HRE 2")]
        [TestCase("vie\u0323\u0302t*", "VI\u1ec6T (1)")]
        [TestCase("ISTANBUL", "istanbul")]
        public void APatternMatchesAName(string pattern, string name) =>
            Assert.That(NamePattern.Matches(pattern, name), Is.True);

        [TestCase("", "")]
        [TestCase("", "Floor")]
        [TestCase("Floor", "Floor 2")]
        [TestCase("Floor", "The Floor")]
        [TestCase("*rug", "rug (1)")]
        [TestCase("a*b*c", "acb")]
        [TestCase("*ab", "aba")]
        [TestCase("Mu*", "M\u0075\u0308tze")]
        [TestCase("istanbul", "\u0130stanbul")]
        public void APatternDoesNotMatchOtherNames(string pattern, string name) =>
            Assert.That(NamePattern.Matches(pattern, name), Is.False);
    }
}
