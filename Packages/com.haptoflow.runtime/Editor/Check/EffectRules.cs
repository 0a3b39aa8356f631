#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>Reports which effects the scene uses, and the measured cost of each on this machine since play mode
    /// began. An effect that nothing uses does not run.</summary>
    internal static class EffectRules
    {
        private static readonly (HapticEffects Flag, HapticEffect Effect, string Name)[] OfSurfaces =
        {
            (HapticEffects.Texture, HapticEffect.Texture, "texture"),
            (HapticEffects.Impact, HapticEffect.Impact, "impact"),
            (HapticEffects.Edge, HapticEffect.Edge, "edge"),
        };

        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            if (Descriptions(scene).Any() && UsedEffects(scene).Count == 0)
            {
                yield return new Finding(MessageType.Warning,
                    "No surface has an effect: nothing is felt. Switch on Texture, Impact or Edge on a surface.");
            }
        }

        /// <summary>The effects in use and their cost, as text; empty when nothing uses an effect.</summary>
        public static string Summary(SceneContents scene)
        {
            List<string> used = UsedEffects(scene);
            if (used.Count == 0)
            {
                return "";
            }
            string cost = HasRun(scene) ? "" : " Play the scene once to see what each costs on this machine.";
            return $"The scene uses {string.Join(", ", used)}. No other effect runs.{cost}";
        }

        private static List<string> UsedEffects(SceneContents scene)
        {
            var used = new List<string>();
            foreach ((HapticEffects flag, HapticEffect effect, string name) in OfSurfaces)
            {
                int count = Descriptions(scene).Count(material => (material.Effects & flag) != 0);
                Add(used, name, count, "surface", Cost(scene, effect));
            }
            Add(used, "compensation",
                scene.Outputs.Count(output => output.Processing.Actuator != OutputActuator.Uncompensated), "output",
                Cost(scene, HapticEffect.Compensation));
            Add(used, "exposure guard", scene.Outputs.Count(output => output.Processing.ExposureGuard),
                "output", Cost(scene, HapticEffect.ExposureGuard));
            Add(used, "delay", scene.Outputs.Count(output => output.Processing.DelayMilliseconds > 0f),
                "output", Cost(scene, HapticEffect.Delay));
            return used;
        }

        /// <summary>The materials of all surfaces, and of the colliders to which a rule assigns a material.</summary>
        private static IEnumerable<MaterialDescription> Descriptions(SceneContents scene) => scene.Surfaces
            .Select(surface => surface.SharedDescription)
            .Concat(scene.Answers.Where(answer => answer.Surface is null && answer.CanBeFelt)
                .Select(answer => answer.ByRules.Parts.First(part => part.CanBeFelt).Material?.Description)
                .Where(description => description != null).Select(description => description!));

        private static bool HasRun(SceneContents scene) =>
            OfSurfaces.Any(each => Cost(scene, each.Effect).HasValue);

        private static void Add(List<string> used, string name, int count, string noun, double? microseconds)
        {
            if (count > 0)
            {
                string cost = microseconds.HasValue ? FormattableCost(microseconds.Value) : "";
                used.Add($"{name} ({count} {noun}{(count == 1 ? "" : "s")}{cost})");
            }
        }

        private static string FormattableCost(double microseconds) =>
            System.FormattableString.Invariant($", {microseconds:0.0} us a run");

        /// <summary>The mean time of a run over all styluses, in microseconds; null before the first run.</summary>
        private static double? Cost(SceneContents scene, HapticEffect effect)
        {
            double microseconds = 0.0;
            ulong runs = 0;
            foreach (HapticStylus stylus in scene.Styluses)
            {
                if (stylus.TryGetEffectStatistics(effect, out EffectStatistics statistics))
                {
                    microseconds += statistics.Microseconds;
                    runs += statistics.Runs;
                }
            }
            return runs > 0 ? microseconds / runs : (double?)null;
        }
    }
}
