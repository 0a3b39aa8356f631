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
            "The material that is heard becomes that of the selected Haptic Material, or what the selected object " +
            "feels like: by its Haptic Surface, else by a rule.");
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
                    said = TakeFrom(Selection.activeObject, state, model);
                }
                if (GUILayout.Button(Apply))
                {
                    said = SceneMaterial.Apply(
                        state.PlayedMix(model.Labels), state.Material(state.PlayedIndex).Learnt, Selection.objects);
                }
            }
            return said;
        }

        /// <summary>The material that is heard becomes what is felt of an object; can be undone.</summary>
        /// <returns>What was taken and why, or why nothing was, for people.</returns>
        public static string TakeFrom(Object? selected, TexturePreviewState state, PreviewModel model)
        {
            SelectedMaterial found = SelectedMaterial.Of(selected);
            string remark = found.Remark.Length > 0 ? $" ({found.Remark})" : "";
            if (!SceneMaterial.TryRead(found.Described, out LabelMix mix, out HapticMaterial? learnt))
            {
                return remark.Length > 0
                    ? selected!.name + " is not felt" + remark
                    : "Select an object of the scene or a Haptic Material first";
            }
            state.Take(mix, learnt);
            return $"Took {state.PlayedMix(model.Labels).Title} from {selected!.name}{remark}";
        }
    }
}
