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

    [CustomEditor(typeof(HapticMaterial))]
    [CanEditMultipleObjects]
    internal sealed class HapticMaterialEditor : UnityEditor.Editor
    {
        internal static readonly GUIContent Preview = new GUIContent("Preview",
            "Preview opens the Texture Preview with this material, to hear and see it without a headset.");

        private readonly MaterialSummaryView view = new MaterialSummaryView();

        public override void OnInspectorGUI()
        {
            if (targets.Length == 1 && ((HapticMaterial)target).IsLearnt)
            {
                view.Draw(((HapticMaterial)target).Learnt);
                EditorGUILayout.Space();
            }
            Draw(serializedObject);
            if (GUILayout.Button(Preview))
            {
                TexturePreviewWindow.Open(target);
            }
        }

        internal static void Draw(SerializedObject material)
        {
            material.Update();
            EditorGUILayout.PropertyField(material.FindProperty("description"), GUIContent.none);
            material.ApplyModifiedProperties();
        }
    }

    /// <summary>Draws a <see cref="MaterialDescription"/> in any Inspector, with a searchable list of labels, with
    /// units, and with the stiffness of the model.</summary>
    [CustomPropertyDrawer(typeof(MaterialDescription))]
    internal sealed class MaterialDescriptionDrawer : PropertyDrawer
    {
        private const int FieldRows = 9;
        private const float RemarkWidth = 110f;

        private static readonly GUIContent Learnt = new GUIContent("Learnt Material");
        private static readonly GUIContent ItsOwn = new GUIContent("Learnt Material",
            "The learnt material is part of this asset.");
        private static readonly GUIContent Itself = new GUIContent("this asset");
        private static readonly GUIContent Stiffness = new GUIContent("Stiffness (N/m)");
        private static readonly GUIContent Tone = new GUIContent("Tone (dB/octave)");
        private static readonly GUIContent Effects = new GUIContent("Effects",
            "The effects are what the tip feels here. An effect that no surface uses takes no time.");
        private static readonly string[] EffectToggles = { "texture", "impact", "edge" };

        public override float GetPropertyHeight(SerializedProperty property, GUIContent label) =>
            InspectorRows.Height(FieldRows + (label.text.Length > 0 ? 1 : 0));

        public override void OnGUI(Rect position, SerializedProperty property, GUIContent label)
        {
            var rows = new InspectorRows(position, property);
            if (label.text.Length > 0)
            {
                EditorGUI.LabelField(rows.Next(), label.text, EditorStyles.boldLabel);
            }
            SerializedProperty first = property.FindPropertyRelative("label");
            SerializedProperty second = property.FindPropertyRelative("secondLabel");
            DrawLearnt(rows, property);
            LabelField.Draw(rows.Next(), first, false);
            LabelField.Draw(rows.Next(), second, true);
            bool blends = second.hasMultipleDifferentValues || second.stringValue.Length > 0;
            using (new EditorGUI.DisabledScope(!blends))
            {
                rows.Field("blend");
            }
            DrawStiffness(rows.Next(), property.FindPropertyRelative("stiffnessNewtonsPerMetre"), first);
            rows.Field("strength");
            rows.Field("featureScale");
            rows.Field("toneDbPerOctave", Tone);
            DrawEffects(rows.Next(), property);
        }

        private static void DrawLearnt(InspectorRows rows, SerializedProperty property)
        {
            if (property.serializedObject.targetObject is HapticMaterial { IsLearnt: true })
            {
                EditorGUI.LabelField(rows.Next(), ItsOwn, Itself);
                return;
            }
            rows.Field("learnt", Learnt);
        }

        private static void DrawEffects(Rect row, SerializedProperty property)
        {
            Rect rest = EditorGUI.PrefixLabel(row, Effects);
            var place = new Rect(rest.x, rest.y, rest.width / EffectToggles.Length, rest.height);
            foreach (string name in EffectToggles)
            {
                SerializedProperty toggle = property.FindPropertyRelative(name);
                using (var drawn = new EditorGUI.PropertyScope(place, null, toggle))
                using (var changed = new EditorGUI.ChangeCheckScope())
                {
                    bool isOn = EditorGUI.ToggleLeft(place, drawn.content, toggle.boolValue);
                    if (changed.changed)
                    {
                        toggle.boolValue = isOn;
                    }
                }
                place.x += place.width;
            }
        }

        private static void DrawStiffness(Rect row, SerializedProperty stiffness, SerializedProperty label)
        {
            bool ofModel = !stiffness.hasMultipleDifferentValues && stiffness.floatValue.Equals(0f) &&
                !label.hasMultipleDifferentValues;
            string remark = ofModel ? LabelCatalog.Current.StiffnessRemark(label.stringValue) : "";
            Rect field = row;
            if (remark.Length > 0)
            {
                field.width -= RemarkWidth;
                var place = new Rect(field.xMax + 4f, row.y, RemarkWidth - 4f, row.height);
                EditorGUI.LabelField(place, remark, EditorStyles.miniLabel);
            }
            EditorGUI.PropertyField(field, stiffness, Stiffness);
        }
    }
}
