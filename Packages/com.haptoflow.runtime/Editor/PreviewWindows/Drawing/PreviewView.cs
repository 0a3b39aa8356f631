#nullable enable
using System;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Size, pixel density and skin that a preview window is drawn with. Immutable: another view is another
    /// object.</summary>
    internal sealed class PreviewView
    {
        private readonly double width;
        private readonly double height;
        private readonly PreviewRoom room;

        private PreviewView(double width, double height, double pixelsPerPoint, bool isDark, PreviewRoom room)
        {
            this.room = room;
            this.width = width;
            this.height = height;
            PixelsPerPoint = pixelsPerPoint;
            Palette = isDark ? Palette.Dark : Palette.Light;
            Layout = new PreviewLayout(width, height, room);
        }

        public PreviewLayout Layout { get; }

        public double PixelsPerPoint { get; }

        public Palette Palette { get; }

        /// <summary>The view of a window now. Call this in OnGUI.</summary>
        /// <param name="last">Returned again if nothing changed, which spares the allocation.</param>
        public static PreviewView Of(Rect window, PreviewRoom room, PreviewView? last)
        {
            double width = Math.Round(window.width);
            double height = Math.Round(window.height);
            double pixelsPerPoint = EditorGUIUtility.pixelsPerPoint;
            bool isDark = EditorGUIUtility.isProSkin;
            bool isSame = last != null && last.room == room && last.width == width && last.height == height &&
                last.PixelsPerPoint == pixelsPerPoint && last.Palette == (isDark ? Palette.Dark : Palette.Light);
            return isSame ? last! : new PreviewView(width, height, pixelsPerPoint, isDark, room);
        }
    }
}
