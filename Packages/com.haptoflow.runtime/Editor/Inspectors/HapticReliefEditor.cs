#nullable enable
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a relief: its fields, a profile of its heights, and what they can be taken
    /// from.</summary>
    [CustomEditor(typeof(HapticRelief))]
    internal sealed class HapticReliefEditor : UnityEditor.Editor
    {
        private const float ProfileHeight = 60f;
        private const int MaximumPoints = 512;

        private static readonly string[] Fields =
        {
            "sizeMetres", "depthMillimetres", "tipRadiusMillimetres", "share", "repeats", "tiling", "offset",
        };

        private static readonly GUIContent FromMesh = new GUIContent("Take from a Mesh",
            "Drop a sculpted mesh here: its heights above the plane that its texture coordinates fit best. It suits " +
            "flat pieces whose texture does not overlap, such as wall panels and floor tiles; curved ones are " +
            "refused.");
        private static readonly GUIContent FromLayer = new GUIContent("Take from a Layer",
            "Drop a terrain layer here: the heights of its normal map, which lie on a terrain as its texture does.");

        private readonly ReliefButton bake = new ReliefButton();
        private HapticSurface? surface;
        private string? remark;

        private void OnEnable() =>
            surface = SceneContents.All<HapticSurface>().FirstOrDefault(each => each.Relief == target);

        public override void OnInspectorGUI()
        {
            var relief = (HapticRelief)target;
            // Read before any field is drawn, so that layout and drawing show the same controls.
            string? problem = ReliefRules.ProblemOf(relief);
            bool isBaked = relief.IsBaked;
            serializedObject.Update();
            foreach (string field in Fields)
            {
                EditorGUILayout.PropertyField(serializedObject.FindProperty(field));
            }
            serializedObject.ApplyModifiedProperties();
            if (isBaked)
            {
                EditorGUILayout.HelpBox($"Baked: {relief.Columns} x {relief.Rows} texels. Their middle row:",
                    MessageType.None);
                DrawProfile(relief, EditorGUILayout.GetControlRect(false, ProfileHeight));
            }
            if (problem != null)
            {
                EditorGUILayout.HelpBox(problem, MessageType.Warning);
            }
            DrawSources(relief);
            if (surface != null)
            {
                bake.Draw(surface);
            }
            else
            {
                EditorGUILayout.HelpBox("No Haptic Surface of the open scenes uses this relief. Assign it to one to " +
                    "bake it from that object's material.", MessageType.Info);
            }
        }

        private void DrawSources(HapticRelief relief)
        {
            // Read before the fields are drawn, so that layout and drawing show the same controls.
            string? shown = remark;
            var mesh = (Mesh?)EditorGUILayout.ObjectField(FromMesh, null, typeof(Mesh), false);
            if (mesh != null)
            {
                remark = MeshRelief.Take(
                    relief, mesh, surface != null ? surface.transform.lossyScale : new Vector3(1f, 1f, 1f));
            }
            var layer = (TerrainLayer?)EditorGUILayout.ObjectField(FromLayer, null, typeof(TerrainLayer), false);
            if (layer != null)
            {
                remark = TerrainRelief.Take(relief, layer);
            }
            if (shown != null)
            {
                EditorGUILayout.HelpBox(shown, MessageType.Warning);
            }
        }

        private static void DrawProfile(HapticRelief relief, Rect area)
        {
            if (Event.current.type != EventType.Repaint)
            {
                return;
            }
            int last = System.Math.Min(relief.Columns, MaximumPoints) - 1;
            Vector3[] points = Enumerable.Range(0, last + 1).Select(index => new Vector3(
                area.x + area.width * index / Mathf.Max(1f, last),
                area.y + area.height * (1f - relief.HeightAt(
                    last == 0 ? 0 : index * (relief.Columns - 1) / last, relief.Rows / 2)), 0f)).ToArray();
            Color before = Handles.color;
            Handles.color = EditorGUIUtility.isProSkin ? Color.white : Color.black;
            Handles.DrawAAPolyLine(null, 2f, points);
            Handles.color = before;
        }
    }
}
