#nullable enable
using System;
using HaptoFlow.Preview;

namespace HaptoFlow.Editor
{
    /// <summary>How the window looks now.</summary>
    internal readonly struct PreviewView : IEquatable<PreviewView>
    {
        private readonly double width;
        private readonly double height;
        private readonly PreviewRoom room;

        /// <param name="width">Of the window, in points.</param>
        /// <param name="height">Of the window, in points.</param>
        public PreviewView(double width, double height, double pixelsPerPoint, bool isDark, PreviewRoom room)
        {
            this.room = room;
            this.width = Math.Round(width);
            this.height = Math.Round(height);
            PixelsPerPoint = pixelsPerPoint;
            Palette = isDark ? Palette.Dark : Palette.Light;
            Layout = new PreviewLayout(this.width, this.height, room);
        }

        public PreviewLayout Layout { get; }

        public double PixelsPerPoint { get; }

        public Palette Palette { get; }

        public bool Equals(PreviewView other) => width.Equals(other.width) && height.Equals(other.height) &&
            PixelsPerPoint.Equals(other.PixelsPerPoint) && Palette == other.Palette && room == other.room;

        public override bool Equals(object? other) => other is PreviewView view && Equals(view);

        public override int GetHashCode() => HashCode.Combine(width, height, PixelsPerPoint, Palette, room);
    }
}
