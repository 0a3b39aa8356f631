#nullable enable
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a surface: its material, and how many of its colliders can be felt.</summary>
    [CustomEditor(typeof(HapticSurface))]
    [CanEditMultipleObjects]
    internal sealed class HapticSurfaceEditor : UnityEditor.Editor
    {
        private SerializedProperty shared = null!;
        private SerializedProperty own = null!;
        private SerializedObject? sharedDescription;
        private string extent = "";
        private readonly ReliefButton bake = new ReliefButton();

        private void OnEnable()
        {
            shared = serializedObject.FindProperty("sharedMaterial");
            own = serializedObject.FindProperty("own");
            EditorApplication.hierarchyChanged += CountColliders;
            CountColliders();
        }

        private void OnDisable() => EditorApplication.hierarchyChanged -= CountColliders;

        public override void OnInspectorGUI()
        {
            serializedObject.Update();
            // Read before any field is drawn, so that layout and drawing show the same fields.
            bool several = shared.hasMultipleDifferentValues;
            Object? material = shared.objectReferenceValue;
            EditorGUILayout.PropertyField(shared);
            DrawMaterial(several, material);
            EditorGUILayout.PropertyField(serializedObject.FindProperty("mask"));
            EditorGUILayout.PropertyField(serializedObject.FindProperty("relief"));
            EditorGUILayout.Space();
            EditorGUILayout.PropertyField(serializedObject.FindProperty("includeChildren"));
            EditorGUILayout.PropertyField(serializedObject.FindProperty("feelOwnMotion"));
            EditorGUILayout.PropertyField(serializedObject.FindProperty("grain"));
            EditorGUILayout.PropertyField(serializedObject.FindProperty("variation"));
            EditorGUILayout.PropertyField(serializedObject.FindProperty("seed"));
            if (serializedObject.ApplyModifiedProperties())
            {
                ApplyToScene();
            }
            if (GUILayout.Button(HapticMaterialEditor.Preview))
            {
                TexturePreviewWindow.Open(target);
            }
            if (targets.Length == 1)
            {
                bake.Draw((HapticSurface)target);
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

        private void ApplyToScene()
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
            string relief = "";
            foreach (Object each in targets)
            {
                if (each == null)
                {
                    return;
                }
                var surface = (HapticSurface)each;
                foreach (Collider collider in SceneColliders.Below(new[] { surface.gameObject }))
                {
                    bool isOwn = SceneColliders.SurfaceOf(collider) == surface;
                    felt += isOwn ? 1 : 0;
                    byRays += isOwn && (collider is MeshCollider || collider is TerrainCollider) ? 1 : 0;
                    if (isOwn && surface.Relief != null && ReliefRules.WhyNotFelt(collider) is { } reason)
                    {
                        relief = $" The relief {surface.Relief.name} cannot be felt on {collider.name}, because " +
                            $"{reason}.";
                    }
                }
            }
            extent = ExtentOf(felt, byRays) + relief + RuleSentence();
        }

        /// <summary>A sentence about the rule that applies without this surface; empty without such a rule, or for
        /// several surfaces.</summary>
        private string RuleSentence()
        {
            if (targets.Length != 1)
            {
                return "";
            }
            var surface = (HapticSurface)target;
            var maps = new SceneMaps();
            ColliderMaterial? answer = maps.All.Count == 0
                ? null
                : SceneColliders.Below(new[] { surface.gameObject }).Where(collider =>
                    SceneColliders.SurfaceOf(collider) == surface).Select(maps.Ask).FirstOrDefault();
            if (answer == null || answer.ByRules.Parts.All(part => part.Map is null))
            {
                return "";
            }
            var byRules = new ColliderMaterial(answer.Collider, null, answer.ByRules);
            string instead = $"{byRules.Material} ({byRules.Reason})";
            return answer.Surface is null
                ? $" This surface is disabled, so rules apply: the object feels like {instead}."
                : $" This surface takes precedence over the rules, by which the object would feel like {instead}.";
        }

        private static string ExtentOf(int felt, int byRays)
        {
            string all = felt == 0
                ? "No collider here can be felt. Add a collider that is no trigger."
                : felt == 1 ? "One collider can be felt." : $"{felt} colliders can be felt.";
            return byRays == 0
                ? all
                : $"{all} Meshes and terrains ({byRays}) are felt from their front only: a tip more than " +
                    $"{RayProbe.MaximumDepthMetres * 1000.0:0} mm behind a face counts as outside.";
        }
    }
}
