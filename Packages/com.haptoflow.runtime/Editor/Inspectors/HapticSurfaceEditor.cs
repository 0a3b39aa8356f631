#nullable enable
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a surface: what it is made of, and what of it can be felt.</summary>
    [CustomEditor(typeof(HapticSurface))]
    [CanEditMultipleObjects]
    internal sealed class HapticSurfaceEditor : UnityEditor.Editor
    {
        private static readonly GUIContent Shared = new GUIContent("Shared Material",
            "A Haptic Material asset that several surfaces share; empty to describe one here.");
        private static readonly GUIContent Mask = new GUIContent("Mask",
            "Further materials by a texture, at the place that is touched; empty for none. It counts on readable " +
            "mesh colliders that are not convex.");
        private static readonly GUIContent Children = new GUIContent("Include Children",
            "Colliders of children count too, but for those below another Haptic Surface.");
        private static readonly GUIContent OwnMotion = new GUIContent("Feel Own Motion",
            "The tip's velocity is taken relative to the object; off, relative to the world.");
        private static readonly GUIContent Grain = new GUIContent("Grain",
            "Direction of the first tangent axis in the object's local space: along the grain of wood.");

        private SerializedProperty shared = null!;
        private SerializedProperty own = null!;
        private SerializedProperty mask = null!;
        private SerializedProperty children = null!;
        private SerializedProperty ownMotion = null!;
        private SerializedProperty grain = null!;
        private SerializedObject? sharedDescription;
        private string extent = "";

        private void OnEnable()
        {
            shared = serializedObject.FindProperty("sharedMaterial");
            own = serializedObject.FindProperty("own");
            mask = serializedObject.FindProperty("mask");
            children = serializedObject.FindProperty("includeChildren");
            ownMotion = serializedObject.FindProperty("feelOwnMotion");
            grain = serializedObject.FindProperty("grain");
            EditorApplication.hierarchyChanged += CountColliders;
            CountColliders();
        }

        private void OnDisable() => EditorApplication.hierarchyChanged -= CountColliders;

        public override void OnInspectorGUI()
        {
            serializedObject.Update();
            // What is shown is decided before anything is changed: nothing is drawn that was not laid out.
            bool several = shared.hasMultipleDifferentValues;
            Object? material = shared.objectReferenceValue;
            EditorGUILayout.PropertyField(shared, Shared);
            DrawMaterial(several, material);
            EditorGUILayout.PropertyField(mask, Mask);
            EditorGUILayout.Space();
            EditorGUILayout.PropertyField(children, Children);
            EditorGUILayout.PropertyField(ownMotion, OwnMotion);
            EditorGUILayout.PropertyField(grain, Grain);
            if (serializedObject.ApplyModifiedProperties())
            {
                TakeOver();
            }
            if (GUILayout.Button(HapticMaterialEditor.Preview))
            {
                TexturePreviewWindow.Open(target);
            }
            EditorGUILayout.HelpBox(extent, MessageType.None);
        }

        private void DrawMaterial(bool several, Object? material)
        {
            if (several)
            {
                EditorGUILayout.HelpBox("These surfaces have different shared materials.", MessageType.None);
                return;
            }
            if (material == null)
            {
                EditorGUILayout.PropertyField(own, GUIContent.none);
                return;
            }
            if (sharedDescription == null || sharedDescription.targetObject != material)
            {
                sharedDescription = new SerializedObject(material);
            }
            EditorGUILayout.HelpBox("Changes here change every surface that shares this material.", MessageType.None);
            HapticMaterialEditor.Draw(sharedDescription);
        }

        /// <summary>A running scene knows colliders by what was registered.</summary>
        private void TakeOver()
        {
            foreach (Object each in targets)
            {
                if (Application.isPlaying)
                {
                    ((HapticSurface)each).Refresh();
                }
            }
            CountColliders();
        }

        private void CountColliders()
        {
            int felt = 0;
            int byRays = 0;
            foreach (Object each in targets)
            {
                if (each == null)
                {
                    return;
                }
                var surface = (HapticSurface)each;
                foreach (Collider collider in SceneColliders.Below(new[] { surface.gameObject }))
                {
                    bool mine = SceneColliders.SurfaceOf(collider) == surface;
                    felt += mine ? 1 : 0;
                    byRays += mine && (collider is MeshCollider || collider is TerrainCollider) ? 1 : 0;
                }
            }
            extent = ExtentOf(felt, byRays) + InsteadOf();
        }

        /// <summary>Which rule would count without this surface, where there is one; empty for several surfaces.
        /// </summary>
        private string InsteadOf()
        {
            if (targets.Length != 1)
            {
                return "";
            }
            var surface = (HapticSurface)target;
            var maps = new SceneMaps();
            ColliderAnswer? answer = maps.All.Count == 0
                ? null
                : SceneColliders.Below(new[] { surface.gameObject }).Where(collider =>
                    SceneColliders.SurfaceOf(collider) == surface).Select(maps.Ask).FirstOrDefault();
            if (answer == null || answer.ByRules.Parts.All(part => part.Map is null))
            {
                return "";
            }
            var byRules = new ColliderAnswer(answer.Collider, null, answer.ByRules);
            string instead = $"{byRules.Material} ({byRules.Reason})";
            return answer.Surface is null
                ? $" This surface is off: rules count, and it feels like {instead}."
                : $" This surface wins over the rules, by which it would feel like {instead}.";
        }

        private static string ExtentOf(int felt, int byRays)
        {
            string all = felt == 0
                ? "No collider here can be felt: add one that is no trigger."
                : felt == 1 ? "One collider can be felt." : $"{felt} colliders can be felt.";
            return byRays == 0
                ? all
                : $"{all} Meshes and terrains ({byRays}) are met from their front: a tip deeper than " +
                    $"{RayProbe.DeepestMetres * 1000.0:0} mm behind a face counts as outside.";
        }
    }
}
