using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Watches the texts of a picture: at its end, none may meet another or leave the picture.</summary>
    internal sealed class TextWatch : IDisposable
    {
        private readonly PixelCanvas canvas;
        private readonly List<(string Text, Box Box)> texts = new List<(string, Box)>();

        public TextWatch(PixelCanvas canvas)
        {
            this.canvas = canvas;
            canvas.TextDrawn = (text, box) => texts.Add((text, box));
        }

        public IEnumerable<string> All => texts.Select(each => each.Text);

        public static bool Meet(Box one, Box other) => one.Left < other.Right && other.Left < one.Right &&
            one.Top < other.Bottom && other.Top < one.Bottom;

        public void Dispose()
        {
            Box whole = canvas.Whole;
            Assert.That(texts, Is.Not.Empty);
            for (int index = 0; index < texts.Count; ++index)
            {
                (string text, Box box) = texts[index];
                Assert.That(whole.Contains(box.Left, box.Top) && whole.Contains(box.Right, box.Bottom), Is.True,
                    $"\"{text}\" leaves the picture");
                foreach ((string other, Box otherBox) in texts.Take(index))
                {
                    Assert.That(Meet(box, otherBox), Is.False, $"\"{text}\" lies upon \"{other}\"");
                }
            }
        }
    }
}
