#nullable enable
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The window's controls for the way from the scene and back. Main thread, within OnGUI.</summary>
    internal static class SceneControls
    {
        private static readonly GUIContent Material = new GUIContent("Take from",
            "Drop a Haptic Material here: the material that is heard becomes what it describes.");
        private static readonly GUIContent Take = new GUIContent("Take from Selection",
            "The material that is heard becomes that of the selected surface or Haptic Material.");
        private static readonly GUIContent Apply = new GUIContent("Apply to Selection",
            "The selected objects and Haptic Materials become the material that is heard. Can be undone.");

        /// <returns>What was done, for people; null where nothing was.</returns>
        public static string? Draw(TexturePreviewState state, PreviewModel model)
        {
            string? said = null;
            float before = EditorGUIUtility.labelWidth;
            EditorGUIUtility.labelWidth = PreviewControls.LabelWidth;
            Object? dropped = EditorGUILayout.ObjectField(Material, null, typeof(HapticMaterial), false);
            EditorGUIUtility.labelWidth = before;
            if (SceneMaterial.TryRead(dropped, out LabelMix mix, out HapticMaterial? learnt))
            {
                state.Take(mix, learnt);
            }
            using (new EditorGUILayout.HorizontalScope())
            {
                if (GUILayout.Button(Take))
                {
                    said = TakeFrom(Selection.activeObject, state);
                }
                if (GUILayout.Button(Apply))
                {
                    said = SceneMaterial.Apply(
                        state.HeardMix(model.Labels), state.Material(state.Heard).Learnt, Selection.objects);
                }
            }
            return said;
        }

        private static string TakeFrom(Object? selected, TexturePreviewState state)
        {
            if (!SceneMaterial.TryRead(selected, out LabelMix mix, out HapticMaterial? learnt))
            {
                return "Select a surface or a Haptic Material first";
            }
            state.Take(mix, learnt);
            return $"Took {(learnt != null ? learnt.name : mix.Title)} from {selected!.name}";
        }
    }
}
