using System;
using System.Collections.Generic;
using UnityEngine;
using UnityShim;

namespace UnityEditor
{
    [Flags]
    public enum GizmoType
    {
        Pickable = 1,
        NotInSelectionHierarchy = 2,
        Selected = 4,
        Active = 8,
        InSelectionHierarchy = 16,
        NonSelected = 32,
    }

    public sealed partial class DrawGizmo : Attribute
    {
        public DrawGizmo(GizmoType gizmo)
        {
        }
    }

    public partial class SearchableEditorWindow : EditorWindow
    {
    }

    public partial class SceneView : SearchableEditorWindow
    {
        public static void RepaintAll()
        {
        }
    }

    public sealed partial class Handles
    {
        internal static readonly List<(Vector3 From, Vector3 To, Color Color)> Lines =
            new List<(Vector3 From, Vector3 To, Color Color)>();
        internal static readonly List<string> Labels = new List<string>();

        public static Color color { get; set; } = Color.white;

        public static void DrawLine(Vector3 p1, Vector3 p2) => Lines.Add((p1, p2, color));

        public static void DrawLine(Vector3 p1, Vector3 p2, float thickness) => DrawLine(p1, p2);

        public static void DrawAAPolyLine(Texture2D? lineTex, float width, params Vector3[] points) =>
            ScreenPaint.Add(nameof(DrawAAPolyLine), Around(points), color);

        public static void DrawLines(Vector3[] lineSegments) =>
            ScreenPaint.Add(nameof(DrawLines), Around(lineSegments), color);

        private static Rect Around(Vector3[] points)
        {
            Vector3 low = points[0];
            Vector3 high = points[0];
            foreach (Vector3 point in points)
            {
                low = new Vector3(Mathf.Min(low.x, point.x), Mathf.Min(low.y, point.y), 0f);
                high = new Vector3(Mathf.Max(high.x, point.x), Mathf.Max(high.y, point.y), 0f);
            }
            return new Rect(low.x, low.y, high.x - low.x, high.y - low.y);
        }

        public static void DrawWireDisc(Vector3 center, Vector3 normal, float radius)
        {
        }

        public static void Label(Vector3 position, string text) => Labels.Add(text);

        public static void Label(Vector3 position, string text, GUIStyle style) => Labels.Add(text);
    }
}

namespace UnityEngine
{
    public sealed partial class Gizmos
    {
        internal static readonly List<(Vector3 From, Vector3 To, Color Color)> Lines =
            new List<(Vector3 From, Vector3 To, Color Color)>();

        internal static readonly List<(Vector3 Position, Quaternion Rotation, Vector3 Size, Color Color)> Solids =
            new List<(Vector3 Position, Quaternion Rotation, Vector3 Size, Color Color)>();

        public static Color color { get; set; } = Color.white;

        public static Matrix4x4 matrix { get; set; }

        public static void DrawCube(Vector3 center, Vector3 size) =>
            Solids.Add((matrix.Position, matrix.Rotation, matrix.Scale, color));

        public static void DrawSphere(Vector3 center, float radius) => DrawCube(center, 2f * radius * Vector3.one);

        public static void DrawLine(Vector3 from, Vector3 to) => Lines.Add((from, to, color));

        public static void DrawWireSphere(Vector3 center, float radius)
        {
        }
    }
}
