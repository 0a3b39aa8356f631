using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Asserts that no text of a picture overlaps another or leaves the picture.</summary>
    internal static class LegibleTexts
    {
        public static void Check(SkiaCanvas canvas)
        {
            IReadOnlyList<(string Text, Box Ink)> texts = canvas.Texts;
            Assert.That(texts, Is.Not.Empty);
            for (int index = 0; index < texts.Count; ++index)
            {
                (string text, Box ink) = texts[index];
                Assert.That(
                    canvas.Whole.Contains(ink.Left, ink.Top) && canvas.Whole.Contains(ink.Right, ink.Bottom),
                    Is.True, $"\"{text}\" leaves the picture");
                foreach ((string other, Box otherInk) in texts.Take(index))
                {
                    Assert.That(Overlap(ink, otherInk), Is.False, $"\"{text}\" overlaps \"{other}\"");
                }
            }
        }

        public static bool Overlap(Box one, Box other) => one.Left < other.Right && other.Left < one.Right &&
            one.Top < other.Bottom && other.Top < one.Bottom;
    }
}
