#nullable enable
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>A stylus needs a tip at the right place that looks at some layer.</summary>
    internal static class StylusRules
    {
        // A tip beyond this feels edges and gaps that no eye sees.
        private const float LargestTipMetres = 0.02f;

        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            foreach (HapticStylus stylus in scene.Styluses)
            {
                if (stylus.Tip == null)
                {
                    yield return WithoutTip(stylus);
                }
                if (stylus.Layers.value == 0)
                {
                    yield return new Finding(MessageType.Error,
                        $"{stylus.name} looks at no layer: it feels nothing.", new[] { stylus },
                        new Repair("Look at All Layers", () => SetLayers(stylus)));
                }
                if (stylus.TipRadiusMetres > LargestTipMetres)
                {
                    yield return new Finding(MessageType.Warning,
                        $"The tip of {stylus.name} has a radius of {1000f * stylus.TipRadiusMetres:0} mm: contact " +
                        "begins that far from a surface. A pen has 2 mm.", new[] { stylus });
                }
            }
        }

        private static Finding WithoutTip(HapticStylus stylus)
        {
            string text = $"{stylus.name} names no tip: its own origin is taken, which on a controller is in the grip.";
            Transform? child = stylus.transform.Find("Tip");
            Repair repair = child != null
                ? new Repair("Take Its Child Tip", () => SetTip(stylus, child))
                : new Repair("Add a Tip", () => AddTip(stylus));
            return new Finding(MessageType.Warning, text, new[] { stylus }, repair);
        }

        private static void AddTip(HapticStylus stylus)
        {
            var tip = new GameObject("Tip");
            tip.transform.SetParent(stylus.transform, false);
            Undo.RegisterCreatedObjectUndo(tip, "Add a Tip");
            SetTip(stylus, tip.transform);
        }

        private static void SetTip(HapticStylus stylus, Transform tip)
        {
            using var serialized = new SerializedObject(stylus);
            serialized.FindProperty("tip").objectReferenceValue = tip;
            serialized.ApplyModifiedProperties();
        }

        private static void SetLayers(HapticStylus stylus)
        {
            using var serialized = new SerializedObject(stylus);
            serialized.FindProperty("layers").intValue = ~0;
            serialized.ApplyModifiedProperties();
        }
    }
}
