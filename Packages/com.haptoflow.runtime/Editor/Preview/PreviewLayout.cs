#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>What the left column of a preview window holds.</summary>
    internal enum PreviewRoom
    {
        Default = 0,

        /// <summary>Controls with the sliders unfolded, and the stroke below them.</summary>
        WithSliders = 1,

        WithoutStroke = 2,
    }

    /// <summary>Places of the parts of a preview window, in points: controls and stroke on the left, charts on the
    /// right.</summary>
    internal sealed class PreviewLayout
    {
        /// <summary>The charts are not legible in less, so that a smaller window scrolls.</summary>
        public const double MinimumWidth = 1080.0;

        /// <summary>The charts are not legible in less, so that a smaller window scrolls.</summary>
        public const double MinimumHeight = 932.0;

        private const double MinimumHeightWithoutStroke = 640.0;
        private const double Margin = 8.0;
        private const double LeftWidth = 312.0;
        private const double StrokeHeight = 340.0;
        private const double SlidersHeight = 164.0;

        public PreviewLayout(double width, double height, PreviewRoom room = PreviewRoom.Default)
        {
            double least = room == PreviewRoom.WithoutStroke
                ? MinimumHeightWithoutStroke
                : MinimumHeight + (room == PreviewRoom.WithSliders ? SlidersHeight : 0.0);
            var whole = new Box(0.0, 0.0, Math.Max(MinimumWidth, width), Math.Max(least, height));
            Width = whole.Width;
            Height = whole.Height;
            Box inside = whole.Inside(Margin);
            Box left = inside.Columns(0.0, LeftWidth);
            double stroke = room == PreviewRoom.WithoutStroke ? 0.0 : StrokeHeight + Margin;
            Controls = left.Rows(0.0, left.Height - stroke);
            StrokePanel = left.Rows(left.Height - Math.Max(0.0, stroke - Margin), Math.Max(0.0, stroke - Margin));
            Charts = inside.Columns(LeftWidth + Margin, inside.Width - LeftWidth - Margin);
        }

        /// <summary>Of the whole content, in points; a smaller window scrolls.</summary>
        public double Width { get; }

        /// <summary>Of the whole content, in points; a smaller window scrolls.</summary>
        public double Height { get; }

        public Box Controls { get; }

        /// <summary>The panel of the stroke; empty without one.</summary>
        public Box StrokePanel { get; }

        public Box Charts { get; }

        public static Box Patch(Box strokePanel)
        {
            double width = strokePanel.Width - 24.0;
            double height = width * Stroke.PatchHeightMetres / Stroke.PatchWidthMetres;
            return new Box(strokePanel.Left + 12.0, strokePanel.Top + 32.0, width, height);
        }

        public static Box Motion(Box strokePanel)
        {
            double top = Patch(strokePanel).Bottom + 30.0;
            return new Box(strokePanel.Left + 42.0, top, strokePanel.Width - 84.0, strokePanel.Bottom - 22.0 - top);
        }
    }
}
