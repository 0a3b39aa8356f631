#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Reads the material of scene objects and Haptic Material assets, and assigns it to them in one undo
    /// step. Main thread.</summary>
    internal static class SceneMaterial
    {
        /// <summary>The material of a surface, of a Haptic Material asset, or of an object by a rule.</summary>
        /// <param name="learnt">A learnt material that replaces the mix's first label; null for the label.</param>
        /// <returns>False for anything else.</returns>
        public static bool TryRead(Object? source, out LabelMix mix, out HapticMaterial? learnt)
        {
            mix = default;
            learnt = null;
            Object? described = SelectedMaterial.Of(source).Described;
            if (described == null)
            {
                return false;
            }
            using var serialized = new SerializedObject(described);
            SerializedProperty? shared = serialized.FindProperty("sharedMaterial");
            if (shared != null && shared.objectReferenceValue != null)
            {
                return TryRead(shared.objectReferenceValue, out mix, out learnt);
            }
            string path = described is HapticMaterial ? "description" : "own";
            mix = new LabelMix(serialized.FindProperty(path + ".label").stringValue,
                serialized.FindProperty(path + ".secondLabel").stringValue,
                serialized.FindProperty(path + ".blend").floatValue, "", null,
                serialized.FindProperty(path + ".featureScale").floatValue,
                serialized.FindProperty(path + ".toneDbPerOctave").floatValue);
            learnt = described is HapticMaterial { IsLearnt: true } carrier
                ? carrier
                : serialized.FindProperty(path + ".learnt").objectReferenceValue as HapticMaterial;
            return true;
        }

        /// <summary>Assigns a material to objects. An object with a collider gets a Haptic Surface if it has none. A
        /// surface no longer uses a shared asset; an asset changes for every surface that shares it.</summary>
        /// <param name="learnt">A learnt material that replaces the mix's first label; null for the label.</param>
        /// <returns>A message about what was done.</returns>
        public static string Apply(LabelMix mix, HapticMaterial? learnt, IReadOnlyCollection<Object> selected)
        {
            if (mix.Moves.Count > 0)
            {
                return "Save the changed material as a Haptic Material first";
            }
            Undo.IncrementCurrentGroup();
            Undo.SetCurrentGroupName("Apply " + mix.Title);
            int group = Undo.GetCurrentGroup();
            var done = new List<Object>();
            var left = new List<Object>();
            foreach (Object each in selected)
            {
                (TryApply(mix, learnt, each) ? done : left).Add(each);
            }
            Undo.CollapseUndoOperations(group);
            string remark = left.Count == 0
                ? ""
                : $"; not to {Names(left)}: without a usable collider, not in an open scene, or a Haptic Material of " +
                    "another learnt material";
            return done.Count == 0 && left.Count == 0
                ? "Select objects of the scene, or Haptic Materials, first"
                : $"Applied {mix.Title} to {(done.Count == 0 ? "nothing" : Names(done))}{remark}";
        }

        private static bool TryApply(LabelMix mix, HapticMaterial? learnt, Object target)
        {
            if (target is HapticMaterial material)
            {
                // A Haptic Material with a learnt material cannot become another one.
                if (material.IsLearnt && learnt != material)
                {
                    return false;
                }
                Write(target, "description", mix, material.IsLearnt ? null : learnt);
                return true;
            }
            // Prefab assets are changed in prefab mode only.
            if (!(target is GameObject owner) || EditorUtility.IsPersistent(owner))
            {
                return false;
            }
            if (!owner.TryGetComponent(out HapticSurface surface))
            {
                if (!SceneColliders.Below(new[] { owner }).Any())
                {
                    return false;
                }
                surface = Undo.AddComponent<HapticSurface>(owner);
            }
            Write(surface, "own", mix, learnt);
            return true;
        }

        private static void Write(Object target, string path, LabelMix mix, HapticMaterial? learnt)
        {
            using var serialized = new SerializedObject(target);
            SerializedProperty? shared = serialized.FindProperty("sharedMaterial");
            if (shared != null)
            {
                shared.objectReferenceValue = null;
            }
            serialized.FindProperty(path + ".label").stringValue =
                learnt != null ? learnt.Description.Label : mix.First;
            serialized.FindProperty(path + ".learnt").objectReferenceValue = learnt;
            serialized.FindProperty(path + ".secondLabel").stringValue = mix.Second;
            serialized.FindProperty(path + ".blend").floatValue = mix.Share;
            serialized.FindProperty(path + ".featureScale").floatValue = mix.FeatureScale;
            serialized.FindProperty(path + ".toneDbPerOctave").floatValue = mix.ToneDbPerOctave;
            serialized.ApplyModifiedProperties();
        }

        private static string Names(IEnumerable<Object> objects) =>
            string.Join(", ", objects.Select(each => each.name));
    }
}
