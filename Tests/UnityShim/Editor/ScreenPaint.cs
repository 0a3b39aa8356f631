using System.Collections.Generic;
using UnityEngine;

namespace UnityShim
{
    /// <summary>One call that drew on the screen without being a control.</summary>
    public readonly struct Painted
    {
        public Painted(string call, Rect place, Color color, string text, Texture2D? image)
        {
            Call = call;
            Place = place;
            Color = color;
            Text = text;
            Image = image;
        }

        /// <summary>Name of the method, for example "DrawRect".</summary>
        public string Call { get; }

        public Rect Place { get; }

        public Color Color { get; }

        /// <summary>Empty for shapes and images.</summary>
        public string Text { get; }

        /// <summary>Null for shapes and texts.</summary>
        public Texture2D? Image { get; }
    }

    /// <summary>Records shapes, texts and images that editor code draws, in the order of the calls.</summary>
    public static class ScreenPaint
    {
        private static readonly List<Painted> Calls = new List<Painted>();

        public static IReadOnlyList<Painted> All => Calls;

        public static void Clear() => Calls.Clear();

        internal static void Add(
            string call, Rect place, Color color, string text = "", Texture2D? image = null) =>
            Calls.Add(new Painted(call, place, color, text, image));
    }
}
