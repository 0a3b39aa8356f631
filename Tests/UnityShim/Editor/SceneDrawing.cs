using System;
using System.Collections.Generic;
using UnityEngine;

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

        public static Color color { get; set; } = Color.white;

        public static void DrawLine(Vector3 from, Vector3 to) => Lines.Add((from, to, color));

        public static void DrawWireSphere(Vector3 center, float radius)
        {
        }
    }
}
