#nullable enable
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;

namespace HaptoFlow.EditorTests
{
    public sealed class SurfaceSeedKeeperTests : EditorTest
    {
        [Test]
        public void AComponentAddedInTheEditorHasASeedOfItsOwn()
        {
            uint first = Tagged("Table", "wood").Seed;
            Assert.That(first, Is.Not.Zero);
            Assert.That(Tagged("Table", "wood").Seed, Is.Not.EqualTo(first));
        }

        [Test]
        public void ACopyGetsASeedOfItsOwnAndTheOriginalKeepsIts()
        {
            HapticSurface original = Tagged("Table", "wood");
            uint seed = original.Seed;
            SurfaceSeedKeeper.Renew();
            HapticSurface copy = CopyOf(original);
            SurfaceSeedKeeper.Renew();
            Assert.That(original.Seed, Is.EqualTo(seed));
            Assert.That(copy.Seed, Is.Not.EqualTo(seed).And.Not.Zero);
        }

        [Test]
        public void TheSurfaceThatHadTheSeedKeepsItEvenIfTheOtherIsOlder()
        {
            HapticSurface older = Tagged("Chair", "wood");
            HapticSurface original = Tagged("Table", "wood");
            uint seed = original.Seed;
            SurfaceSeedKeeper.Renew();
            older.Seed = seed;
            SurfaceSeedKeeper.Renew();
            Assert.That(original.Seed, Is.EqualTo(seed));
            Assert.That(older.Seed, Is.Not.EqualTo(seed));
        }

        [Test]
        public void UndoRestoresTheSeedOfTheCopy()
        {
            HapticSurface original = Tagged("Table", "wood");
            SurfaceSeedKeeper.Renew();
            HapticSurface copy = CopyOf(original);
            Undo.IncrementCurrentGroup();
            SurfaceSeedKeeper.Renew();
            Undo.PerformUndo();
            Assert.That(copy.Seed, Is.EqualTo(original.Seed));
        }

        [Test]
        public void SurfacesWithoutASeedStayWithoutOne()
        {
            HapticSurface first = Tagged("Table", "wood");
            HapticSurface second = Tagged("Table", "wood");
            (first.Seed, second.Seed) = (0u, 0u);
            SurfaceSeedKeeper.Renew();
            Assert.That((first.Seed, second.Seed), Is.EqualTo((0u, 0u)));
        }

        private HapticSurface CopyOf(HapticSurface original)
        {
            HapticSurface copy = Tagged(original.name, "wood");
            copy.Seed = original.Seed;
            return copy;
        }
    }
}
