#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Checks that pens are known for what they are, and that the hand of every pen is known.</summary>
    internal static class PenRules
    {
        public static IEnumerable<Finding> Check(SceneContents scene) => Check(scene, MxInkSupport.OfProject());

        internal static IEnumerable<Finding> Check(SceneContents scene, MxInkSupport mxInk)
        {
            XrPen[] pens = Object
                .FindObjectsByType<XrPen>(FindObjectsInactive.Exclude, FindObjectsSortMode.None)
                .Where(pen => pen.enabled)
                .OrderBy(pen => pen.name, StringComparer.Ordinal)
                .ToArray();
            if (mxInk.IsLacking && pens.Length > 0)
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
                        new Repair("Right Hand", () => SetHand(stylus, HapticHand.Right)),
                        new Repair("Left Hand", () => SetHand(stylus, HapticHand.Left)));
                }
            }
        }

        private static void SetHand(HapticStylus stylus, HapticHand hand) =>
            SerializedFields.Set(stylus, "hand", property => property.intValue = (int)hand);
    }
}
