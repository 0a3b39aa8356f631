#nullable enable
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Editor
{
    /// <summary>Looks a scene and its project over. Changes nothing by itself.</summary>
    internal static class SceneCheck
    {
        /// <summary>The worst first.</summary>
        public static IReadOnlyList<Finding> Run() => Run(new SceneContents());

        /// <summary>The worst first, of a scene that was searched already.</summary>
        public static IReadOnlyList<Finding> Run(SceneContents scene)
        {
            return SettingsRules.Check()
                .Concat(StylusRules.Check(scene))
                .Concat(SurfaceRules.Check(scene))
                .Concat(LearntMaterialRules.Check(scene))
                .Concat(ColliderRules.Check(scene))
                .Concat(MapRules.Check(scene))
                .Concat(OutputRules.Check(scene))
                .Concat(SilentOutputRules.Check(scene))
                .Concat(RealObjectRules.Check(scene))
                .Concat(EffectRules.Check(scene))
                .OrderByDescending(finding => finding.Severity)
                .ToArray();
        }
    }
}
