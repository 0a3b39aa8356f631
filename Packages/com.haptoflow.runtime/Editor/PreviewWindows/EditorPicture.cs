#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>A picture of charts, drawn with Unity's IMGUI. The calls of the charts are recorded when content or
    /// view change, and replayed without garbage at each repaint. Main thread. Must be released, because Unity keeps
    /// textures until the editor closes.</summary>
    internal sealed class EditorPicture : ICanvas
    {
        // Points closer to each other than this are left out of polylines.
        private const float PointDistance = 0.25f;

        // Handles.DrawLines multiplies the opacity of its colour by this.
        private const float LineOpacity = 0.75f;

        private readonly Action<ICanvas> draw;
        private readonly List<Action> commands = new List<Action>();
        private readonly Dictionary<ColourImage, Texture2D> textures = new Dictionary<ColourImage, Texture2D>();
        private readonly HashSet<ColourImage> used = new HashSet<ColourImage>();
        private readonly Dictionary<(int, bool, TextAlign), GUIStyle> styles =
            new Dictionary<(int, bool, TextAlign), GUIStyle>();
        private readonly GUIContent measured = new GUIContent();
        private object? shownContent;
        private PreviewView? shownView;

        /// <param name="draw">Draws the charts; called again for each new content or view.</param>
        public EditorPicture(Action<ICanvas> draw) => this.draw = draw;

        public double PixelsPerPoint { get; private set; } = 1.0;

        /// <summary>Call this in OnGUI. Draws only when the event is a repaint.</summary>
        /// <param name="content">What the charts show; another object is another content.</param>
        /// <param name="view">Another object is another view.</param>
        public void OnGUI(object content, PreviewView view)
        {
            if (Event.current.type != EventType.Repaint)
            {
                return;
            }
            if (!ReferenceEquals(content, shownContent) || !ReferenceEquals(view, shownView))
            {
                Record(view);
                shownContent = content;
                shownView = view;
            }
            Color before = Handles.color;
            foreach (Action command in commands)
            {
                command();
            }
            Handles.color = before;
        }

        public void Release()
        {
            used.Clear();
            DestroyUnusedTextures();
            commands.Clear();
            shownContent = null;
        }

        void ICanvas.FillRectangle(Box box, Colour colour, double cornerRadius)
        {
            Rect rect = box.ToRect();
            Color color = colour.ToColor();
            var radius = (float)cornerRadius;
            if (radius > 0f)
            {
                commands.Add(() => GUI.DrawTexture(
                    rect, Texture2D.whiteTexture, ScaleMode.StretchToFill, true, 0f, color, 0f, radius));
            }
            else
            {
                commands.Add(() => EditorGUI.DrawRect(rect, color));
            }
        }

        void ICanvas.DrawPolyline(IReadOnlyList<(double X, double Y)> points, double width, Colour colour)
        {
            var kept = new List<Vector3>();
            for (int index = 0; index < points.Count; ++index)
            {
                var point = new Vector3((float)points[index].X, (float)points[index].Y, 0f);
                if (index == points.Count - 1 || kept.Count == 0 ||
                    (point - kept[kept.Count - 1]).magnitude >= PointDistance)
                {
                    kept.Add(point);
                }
            }
            Vector3[] line = kept.ToArray();
            Color color = colour.ToColor();
            var thickness = (float)width;
            commands.Add(() =>
            {
                Handles.color = color;
                Handles.DrawAAPolyLine(null, thickness, line);
            });
        }

        /// <summary>One vertical line through the middle of each column of pixels, all in one draw call.</summary>
        void ICanvas.FillArea(IReadOnlyList<(double X, double Top, double Bottom)> edges, Colour colour)
        {
            Vector3[] lines = PixelColumns(edges);
            Color color = colour.ToColor();
            color.a /= LineOpacity;
            commands.Add(() =>
            {
                Handles.color = color;
                Handles.DrawLines(lines);
            });
        }

        void ICanvas.DrawText(
            string text, double x, double y, double size, Colour colour, TextAlign align, bool bold)
        {
            var content = new GUIContent(text);
            GUIStyle style = Style(size, bold, align);
            var width = (float)Math.Ceiling(((ICanvas)this).MeasureText(text, size, bold));
            float left = (float)x - (align == TextAlign.Right ? width : align == TextAlign.Centre ? 0.5f * width : 0f);
            var height = (float)(2.0 * size);
            var rect = new Rect(left, (float)y - 0.5f * height, width, height);
            Color color = colour.ToColor();
            commands.Add(() =>
            {
                Color before = GUI.contentColor;
                GUI.contentColor = color;
                style.Draw(rect, content, false, false, false, false);
                GUI.contentColor = before;
            });
        }

        double ICanvas.MeasureText(string text, double size, bool bold)
        {
            measured.text = text;
            return Style(size, bold, TextAlign.Left).CalcSize(measured).x;
        }

        void ICanvas.DrawImage(ColourImage image, Box box)
        {
            used.Add(image);
            if (!textures.TryGetValue(image, out Texture2D? known) || known == null)
            {
                textures[image] = known = MakeTexture(image);
            }
            Texture2D texture = known;
            Rect rect = box.ToRect();
            commands.Add(() => GUI.DrawTexture(rect, texture, ScaleMode.StretchToFill));
        }

        void ICanvas.BeginClip(Box box)
        {
            Rect rect = box.ToRect();
            // The offset keeps the coordinates inside the clip those of the window.
            Vector2 offset = Vector2.zero - rect.position;
            commands.Add(() => GUI.BeginClip(rect, offset, Vector2.zero, false));
        }

        void ICanvas.EndClip() => commands.Add(() => GUI.EndClip());

        private void Record(PreviewView view)
        {
            PixelsPerPoint = view.PixelsPerPoint;
            commands.Clear();
            used.Clear();
            draw(this);
            DestroyUnusedTextures();
        }

        private void DestroyUnusedTextures()
        {
            foreach (ColourImage image in new List<ColourImage>(textures.Keys))
            {
                if (!used.Contains(image))
                {
                    Object.DestroyImmediate(textures[image]);
                    textures.Remove(image);
                }
            }
        }

        private static Texture2D MakeTexture(ColourImage image)
        {
            var texture = new Texture2D(image.Width, image.Height, TextureFormat.RGBA32, false)
            {
                name = "HaptoFlow Preview",
                hideFlags = HideFlags.HideAndDontSave,
                wrapMode = TextureWrapMode.Clamp,
            };
            texture.LoadRawTextureData(image.Pixels);
            texture.Apply(false, true);
            return texture;
        }

        private Vector3[] PixelColumns(IReadOnlyList<(double X, double Top, double Bottom)> edges)
        {
            var lines = new List<Vector3>();
            double pixel = 1.0 / PixelsPerPoint;
            int next = 1;
            double first = (Math.Floor(edges[0].X / pixel) + 0.5) * pixel;
            for (double x = first; next < edges.Count; x += pixel)
            {
                while (next < edges.Count && edges[next].X < x)
                {
                    ++next;
                }
                (double X, double Top, double Bottom) to = edges[Math.Min(next, edges.Count - 1)];
                (double X, double Top, double Bottom) from = edges[Math.Min(next, edges.Count - 1) - 1];
                double share = Math.Max(0.0, Math.Min(1.0, (x - from.X) / Math.Max(1e-9, to.X - from.X)));
                lines.Add(new Vector3((float)x, (float)(from.Top + share * (to.Top - from.Top)), 0f));
                lines.Add(new Vector3((float)x, (float)(from.Bottom + share * (to.Bottom - from.Bottom)), 0f));
            }
            return lines.ToArray();
        }

        /// <summary>The editor's own label font in white, so that GUI.contentColor is the text's colour.</summary>
        private GUIStyle Style(double size, bool bold, TextAlign align)
        {
            (int, bool, TextAlign) key = ((int)Math.Round(size), bold, align);
            if (!styles.TryGetValue(key, out GUIStyle? style))
            {
                style = new GUIStyle(bold ? EditorStyles.boldLabel : EditorStyles.label)
                {
                    fontSize = key.Item1,
                    padding = new RectOffset(0, 0, 0, 0),
                    wordWrap = false,
                    richText = false,
                    clipping = TextClipping.Overflow,
                    alignment = align == TextAlign.Left ? TextAnchor.MiddleLeft
                        : align == TextAlign.Right ? TextAnchor.MiddleRight : TextAnchor.MiddleCenter,
                };
                style.normal.textColor = Color.white;
                styles[key] = style;
            }
            return style;
        }
    }

    /// <summary>Preview types as Unity's.</summary>
    internal static class PreviewConversions
    {
        public static Rect ToRect(this Box box) =>
            new Rect((float)box.Left, (float)box.Top, (float)box.Width, (float)box.Height);

        public static Color ToColor(this Colour colour) =>
            new Color(colour.Red / 255f, colour.Green / 255f, colour.Blue / 255f, colour.Opacity / 255f);
    }

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

    /// <summary>Marks the position of playback on top of pictures that need not be drawn again. Main thread, within
    /// OnGUI.</summary>
    internal static class Playhead
    {
        private const double TipPoints = 8.0;

        /// <summary>Draws the tip on the patch while it touches.</summary>
        /// <param name="material">Index of the material that is played.</param>
        public static void DrawTip(Box patch, in StrokeState tip, Palette palette, int material)
        {
            if (tip.Touching)
            {
                (double x, double y) = PatchPicture.ToPoints(patch, tip.XMetres, tip.YMetres);
                var mark = new Box(x - 0.5 * TipPoints, y - 0.5 * TipPoints, TipPoints, TipPoints);
                EditorGUI.DrawRect(mark.ToRect(), (material == 0 ? palette.First : palette.Second).ToColor());
            }
        }

        /// <summary>Draws a line through every plot over time.</summary>
        public static void DrawLines(
            Box charts, SoundPanel panel, IReadOnlyList<AnalysedSound> sounds, double seconds, Palette palette)
        {
            for (int index = 0; index < sounds.Count; ++index)
            {
                double share = seconds / sounds[index].Sound.DurationSeconds;
                foreach (Box plot in panel.Plots(charts, index))
                {
                    Draw(plot, share, palette);
                }
            }
        }

        private static void Draw(Box plot, double share, Palette palette) =>
            EditorGUI.DrawRect(plot.Columns(share * plot.Width, 1.0).ToRect(), palette.Ink.ToColor());
    }
}
