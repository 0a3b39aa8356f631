#nullable enable
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Editor
{
    /// <summary>Checks the open scenes and the project. Changes nothing by itself.</summary>
    internal static class SceneCheck
    {
        /// <summary>All findings, the most severe first.</summary>
        public static IReadOnlyList<Finding> Run() => Run(new SceneContents());

        /// <summary>All findings in contents that were already collected, the most severe first.</summary>
        public static IReadOnlyList<Finding> Run(SceneContents scene)
        {
            return SettingsRules.Check()
                .Concat(StylusRules.Check(scene))
                .Concat(PenRules.Check(scene))
                .Concat(SurfaceRules.Check(scene))
                .Concat(LearntMaterialRules.Check(scene))
                .Concat(ColliderRules.Check(scene))
                .Concat(MapRules.Check(scene))
                .Concat(OutputRules.Check(scene))
                .Concat(SilentOutputRules.Check(scene))
                .Concat(PlaceRules.Check(scene))
                .Concat(RealObjectRules.Check(scene))
                .Concat(EffectRules.Check(scene))
                .OrderByDescending(finding => finding.Severity)
                .ToArray();
        }
    }
}
