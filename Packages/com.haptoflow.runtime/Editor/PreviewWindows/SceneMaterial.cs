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
            MaterialDescription? description = SelectedMaterial.Of(source).Described switch
            {
                HapticMaterial asset => asset.Description,
                HapticSurface surface => surface.SharedDescription,
                _ => null,
            };
            mix = description == null
                ? default
                : new LabelMix(description.Label, description.SecondLabel, description.Blend, "", null,
                    description.FeatureScale, description.ToneDbPerOctave);
            learnt = description?.Learnt;
            return description != null;
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

    /// <summary>Finds the material of a selected object: a Haptic Material, a surface, or an object with a material by
    /// its surface or by a rule. Main thread.</summary>
    internal readonly struct SelectedMaterial
    {
        private SelectedMaterial(
            Object? described, string remark = "", bool isObject = false, HapticRelief? relief = null) =>
            (Described, Remark, IsObject, Relief) = (described, remark, isObject, relief);

        /// <summary>The surface or the Haptic Material with the description; null if the object has none.</summary>
        public Object? Described { get; }

        /// <summary>For display: the rule and the part of the object that were used, or why there is no material. Empty
        /// without a remark.</summary>
        public string Remark { get; }

        /// <summary>True for a surface or an object of the scene, which alone can have a relief.</summary>
        public bool IsObject { get; }

        /// <summary>The relief of the surface, or of the part of the object that was used; null for none.</summary>
        public HapticRelief? Relief { get; }

        public static SelectedMaterial Of(Object? selected)
        {
            if (selected is GameObject owner && owner != null)
            {
                return OfObject(owner);
            }
            if (selected is HapticSurface surface && surface != null)
            {
                return OfSurface(surface);
            }
            return new SelectedMaterial(selected is HapticMaterial && selected != null ? selected : null);
        }

        private static SelectedMaterial OfSurface(HapticSurface surface, string remark = "") =>
            new SelectedMaterial(surface, remark, true, surface.Relief != null ? surface.Relief : null);

        /// <summary>In this order: the object's own surface, its colliders' material, a disabled surface.</summary>
        private static SelectedMaterial OfObject(GameObject owner)
        {
            bool hasOwn = owner.TryGetComponent(out HapticSurface own);
            if (hasOwn && own.enabled)
            {
                return OfSurface(own);
            }
            var maps = new SceneMaps();
            ColliderMaterial[] answers = SceneColliders.Below(new[] { owner }).Select(maps.Ask)
                .OrderBy(answer => answer.Collider.gameObject == owner ? 0 : 1).ToArray();
            ColliderMaterial? touchable = answers.FirstOrDefault(answer => answer.CanBeFelt);
            if (touchable != null)
            {
                return touchable.Surface is object ? OfSurface(touchable.Surface) : OfRule(owner, touchable);
            }
            HapticSurface? described = hasOwn ? own
                : answers.Length == 0 ? SurfaceRegistry.OwnerOf(owner.transform)
                : answers.Select(answer => SceneColliders.SurfaceOf(answer.Collider))
                    .FirstOrDefault(surface => surface != null);
            if (described != null)
            {
                return OfSurface(described, described.isActiveAndEnabled ? "" : "its Haptic Surface is disabled");
            }
            return new SelectedMaterial(null, WhyNot(answers));
        }

        private static SelectedMaterial OfRule(GameObject owner, ColliderMaterial answer)
        {
            MappedCollider mapped = answer.ByRules;
            int index = 0;
            while (!mapped.Parts[index].CanBeFelt)
            {
                ++index;
            }
            MappedPart part = mapped.Parts[index];
            var remarks = new List<string>();
            if (answer.Collider.gameObject != owner)
            {
                remarks.Add(answer.Collider.name);
            }
            if (!mapped.IsUniform)
            {
                string kind = mapped.Facts.Terrain is object ? "layer" : "submesh";
                remarks.Add($"{kind} {index + 1} of {mapped.Parts.Count}");
            }
            remarks.Add(part.Explain());
            if (part.Mask is object)
            {
                remarks.Add(part.Material is object
                    ? $"without its mask {part.Mask.name}"
                    : $"the first material of its mask {part.Mask.name}");
            }
            return new SelectedMaterial(
                part.Material ?? FirstOf(part.Mask), string.Join("; ", remarks), true, part.Relief);
        }

        private static HapticMaterial? FirstOf(HapticMaskMap? mask) => mask is null
            ? null
            : new[] { mask.Red, mask.Green, mask.Blue, mask.Alpha }
                .Where(channel => channel.Use == MaskChannelUse.Material && channel.Material != null)
                .Select(channel => channel.Material).FirstOrDefault();

        private static string WhyNot(IReadOnlyCollection<ColliderMaterial> answers)
        {
            if (answers.Count == 0)
            {
                return "it has no collider that can be touched";
            }
            ColliderMaterial first = answers.FirstOrDefault(
                answer => answer.ByRules.Parts.Any(part => part.Map is object)) ?? answers.First();
            return first.ByRules.Parts.All(part => part.Map is null)
                ? "it has no Haptic Surface, and no rule matches"
                : first.Reason;
        }
    }

    /// <summary>Controls that copy the material from the scene and to it. Main thread, within OnGUI.</summary>
    internal static class SceneControls
    {
        private static readonly GUIContent Material = new GUIContent("Take from",
            "Drop a Haptic Material here to preview it in place of the active material.");
        private static readonly GUIContent Take = new GUIContent("Take from Selection",
            "Previews the material of the selection in place of the active one: that of a Haptic Material, or of an " +
            "object by its Haptic Surface or by a rule, with the object's relief.");
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
            state.Take(mix, learnt, found);
            string relief = found.Relief != null ? $" with its relief {found.Relief.name}" : "";
            return $"Took {state.PlayedMix(model.Labels).Title} from {selected!.name}{relief}{remark}";
        }
    }
}
