#nullable enable
using System;
using System.IO;
using System.Linq;
using HaptoFlow.Model;
using HaptoFlow.Tests.Support;
using Newtonsoft.Json.Linq;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    public sealed class LabelSpellingTests
    {
        private static readonly string[][] Groups = JArray
            .Parse(File.ReadAllText(Path.Combine(RepositoryFiles.Root, "Tests", "Golden", "labels", "labels.json")))
            .Select(group => group.Select(spelling => (string)spelling!).ToArray())
            .ToArray();

        [Test]
        public void SpellingsOfOneLabelAreTheSameAndThoseOfTwoAreNotByTheGoldenFile()
        {
            var names = new LabelNames(Groups.Select(group => group[0]));
            Assert.That(Groups, Has.Length.GreaterThan(20));
            for (int expected = 0; expected < Groups.Length; ++expected)
            {
                foreach (string spelling in Groups[expected])
                {
                    Assert.That(names.TryFind(spelling, out int index), Is.True, spelling);
                    Assert.That(index, Is.EqualTo(expected), spelling);
                    Assert.That(names.TryFind(spelling, out int again) && again == index, Is.True, spelling);
                }
            }
            Assert.That(names.TryFind("ahren", out _), Is.False);
            Assert.That(names.TryFind("ahren", out _), Is.False, "asked again");
        }

        [Test]
        public void ASpellingThatWasAskedBeforeCostsNoGarbage()
        {
            var names = new LabelNames(new[] { "wood", "\u00e4hre" });
            Assert.That(names.TryFind("A\u0308HRE", out int index), Is.True);
            Assert.That(index, Is.EqualTo(1));
            Assert.That(AllocatedByHundredQuestions(names, "A\u0308HRE"), Is.Zero);
            Assert.That(AllocatedByHundredQuestions(names, "Wood"), Is.Zero);
        }

        [System.Runtime.CompilerServices.MethodImpl(System.Runtime.CompilerServices.MethodImplOptions.NoInlining)]
        private static long AllocatedByHundredQuestions(LabelNames names, string spelling)
        {
            names.TryFind(spelling, out _);
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int question = 0; question < 100; ++question)
            {
                names.TryFind(spelling, out _);
            }
            return GC.GetAllocatedBytesForCurrentThread() - before;
        }

        [Test]
        public void HalfOfASurrogatePairIsComparedAsItIs() =>
            Assert.That(LabelSpelling.Same.Equals("w\ud83e", "W\ud83e"), Is.True);
    }
}
