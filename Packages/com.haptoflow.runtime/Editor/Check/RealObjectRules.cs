#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Alignment;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
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
            HapticAlignment[] all = Object.FindObjectsByType<HapticAlignment>(
                FindObjectsInactive.Exclude, FindObjectsSortMode.None);
            foreach (HapticAlignment alignment in all.Where(each => each.enabled)
                .OrderBy(each => each.name, StringComparer.Ordinal))
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
