#nullable enable
using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Checks that every stylus has a tip of a plausible size, and layers that it can feel.</summary>
    internal static class StylusRules
    {
        // A larger tip touches surfaces visibly before it reaches them.
        private const float MaximumTipMetres = 0.02f;

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
                        $"{stylus.name} has no layer in its field Layers: it feels nothing.", new[] { stylus },
                        new Repair("Feel All Layers", () => FeelAllLayers(stylus)));
                }
                Transform? rig = RigScale.RigOf(stylus);
                double scale = RigScale.Of(rig);
                if (rig != null && scale != 1.0)
                {
                    yield return new Finding(MessageType.Info,
                        FormattableString.Invariant($"{rig.name}, the rig of {stylus.name}, has the scale {scale:0.###}: ") +
                        FormattableString.Invariant($"a centimetre of the hand is {scale:0.###} cm of the world. ") +
                        "Speed, depth, force and the tip's radius are the hand's; surfaces " +
                        "and their features keep their size in the world. If the pen is drawn at another scale, but its " +
                        "hand is not, choose its tracking space in the field Rig.", new UnityEngine.Object[] { stylus, rig });
                }
                if (stylus.TipRadiusMetres > MaximumTipMetres)
                {
                    yield return new Finding(MessageType.Warning,
                        $"The tip of {stylus.name} has a radius of {1000f * stylus.TipRadiusMetres:0} mm: contact " +
                        "begins that far from a surface. A pen has 2 mm.", new[] { stylus });
                }
            }
        }

        private static Finding WithoutTip(HapticStylus stylus)
        {
            string text = $"{stylus.name} has no tip: its origin serves as the tip, which on a controller is in the " +
                "grip.";
            Transform? child = stylus.transform.Find("Tip");
            Repair repair = child != null
                ? new Repair("Use Its Child Tip", () => SetTip(stylus, child))
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

        private static void SetTip(HapticStylus stylus, Transform tip) =>
            SerializedFields.Set(stylus, "tip", property => property.objectReferenceValue = tip);

        private static void FeelAllLayers(HapticStylus stylus) =>
            SerializedFields.Set(stylus, "layers", property => property.intValue = ~0);
    }
}
