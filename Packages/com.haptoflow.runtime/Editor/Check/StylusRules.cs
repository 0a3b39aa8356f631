#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Alignment;
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

    /// <summary>Checks that pens are known for what they are, and that the hand of every pen is known.</summary>
    internal static class PenRules
    {
        public static IEnumerable<Finding> Check(SceneContents scene) => Check(scene, MxInkSupport.OfProject());

        internal static IEnumerable<Finding> Check(SceneContents scene, MxInkSupport mxInk)
        {
            IReadOnlyList<XrPen> pens = SceneContents.All<XrPen>();
            if (mxInk.IsLacking && pens.Count > 0)
            {
                yield return new Finding(MessageType.Info,
                    $"{string.Join(", ", pens.Select(pen => pen.name))}: the project has no interaction profile of MX " +
                    "Ink, so a headset presents that pen as a Touch controller, without the force of its tip. " +
                    $"{DisguisedMxInk.MissingProfile} For controllers nothing is missing.", pens,
                    mxInk.CanSwitchOn
                        ? new[] { new Repair("Switch On Profile of MX Ink", MxInkSwitch.SwitchOn) }
                        : Array.Empty<Repair>());
            }
            foreach (HapticStylus stylus in scene.Styluses)
            {
                if (stylus.Force != null && stylus.Hand == HapticHand.None)
                {
                    yield return new Finding(MessageType.Info,
                        $"{stylus.name} measures the force of its tip, but its field Hand is None: no controller or pen " +
                        "in a hand plays it, unless its Tip Force finds out the hand, as Tip Force (Meta) does. A pen on " +
                        "a tablet is in no hand; for another choose the hand.", new[] { stylus },
                        Repair.ChooseHand(stylus));
                }
            }
        }
    }

    /// <summary>Checks scenes with real objects under virtual ones: whether the touch force is measured, and whether
    /// the marks of an alignment determine a pose.</summary>
    internal static class RealObjectRules
    {
        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            foreach (HapticStylus stylus in scene.Styluses)
            {
                if (stylus.TouchBy == TouchDecision.MeasuredForce && stylus.Force == null)
                {
                    yield return new Finding(MessageType.Warning,
                        $"{stylus.name} has Touch By set to Measured Force, but its field Tip Force is empty: " +
                        "geometry decides.",
                        new[] { stylus });
                }
            }
            foreach (HapticAlignment alignment in SceneContents.All<HapticAlignment>())
            {
                Vector3 scale = alignment.transform.lossyScale;
                string? problem = ThreePointFit.WhyMarksUnusable(
                    alignment.Marks.Select(mark => Vector3.Scale(scale, mark).ToDouble()).ToArray());
                if (problem != null)
                {
                    yield return new Finding(MessageType.Warning,
                        $"{alignment.name} cannot be aligned: {problem}.", new[] { alignment });
                }
            }
        }
    }
}
