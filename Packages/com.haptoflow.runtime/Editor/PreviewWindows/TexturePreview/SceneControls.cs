#nullable enable
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Controls that copy the material from the scene and to it. Main thread, within OnGUI.</summary>
    internal static class SceneControls
    {
        private static readonly GUIContent Material = new GUIContent("Take from",
            "Drop a Haptic Material here to preview it in place of the active material.");
        private static readonly GUIContent Take = new GUIContent("Take from Selection",
            "Previews the material of the selection in place of the active one: that of a Haptic Material, or of an " +
            "object by its Haptic Surface or by a rule.");
        private static readonly GUIContent Apply = new GUIContent("Apply to Selection",
            "Assigns the active material to the selected objects and Haptic Materials. Can be undone.");

        /// <returns>A message about what was done; null if nothing was.</returns>
        public static string? Draw(TexturePreviewState state, PreviewModel model)
        {
            string? message = null;
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
                    message = TakeFrom(Selection.activeObject, state, model);
                }
                if (GUILayout.Button(Apply))
                {
                    message = SceneMaterial.Apply(
                        state.PlayedMix(model.Labels), state.Material(state.PlayedIndex).Learnt, Selection.objects);
                }
            }
            return message;
        }

        /// <summary>Previews the material of an object in place of the active one. Can be undone.</summary>
        /// <returns>A message about what was taken and why, or why nothing was.</returns>
        public static string TakeFrom(Object? selected, TexturePreviewState state, PreviewModel model)
        {
            SelectedMaterial found = SelectedMaterial.Of(selected);
            string remark = found.Remark.Length > 0 ? $" ({found.Remark})" : "";
            if (!SceneMaterial.TryRead(found.Described, out LabelMix mix, out HapticMaterial? learnt))
            {
                return remark.Length > 0
                    ? selected!.name + " has no haptic material" + remark
                    : "Select an object of the scene or a Haptic Material first";
            }
            state.Take(mix, learnt);
            return $"Took {state.PlayedMix(model.Labels).Title} from {selected!.name}{remark}";
        }
    }
}
