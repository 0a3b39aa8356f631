#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>Says which effects the scene calls for and what each has cost on this machine since play began. An effect
    /// that nothing calls for does not run.</summary>
    internal static class EffectRules
    {
        private static readonly (HapticEffects Asked, HapticEffect Effect, string Name)[] OfSurfaces =
        {
            (HapticEffects.Texture, HapticEffect.Texture, "texture"),
            (HapticEffects.Impact, HapticEffect.Impact, "impact"),
            (HapticEffects.Edge, HapticEffect.Edge, "edge"),
        };

        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            if (Descriptions(scene).Any() && Called(scene).Count == 0)
            {
                yield return new Finding(MessageType.Warning,
                    "No surface calls for an effect: nothing is felt. Switch on Texture, Impact or Edge on a surface.");
            }
        }

        /// <summary>The effects and their cost, for people; empty where nothing calls for an effect.</summary>
        public static string Summary(SceneContents scene)
        {
            List<string> called = Called(scene);
            if (called.Count == 0)
            {
                return "";
            }
            string cost = HasRun(scene) ? "" : " Play the scene once to see what each costs on this machine.";
            return $"The scene calls for {string.Join(", ", called)}. Nothing else runs.{cost}";
        }

        private static List<string> Called(SceneContents scene)
        {
            var called = new List<string>();
            foreach ((HapticEffects asked, HapticEffect effect, string name) in OfSurfaces)
            {
                int count = Descriptions(scene).Count(material => (material.Effects & asked) != 0);
                Add(called, name, count, "surface", Cost(scene, effect));
            }
            Add(called, "compensation", scene.Outputs.Count(output => output.Processing.Actuator != OutputActuator.Uncompensated),
                "output", Cost(scene, HapticEffect.Compensation));
            Add(called, "exposure guard", scene.Outputs.Count(output => output.Processing.ExposureGuard),
                "output", Cost(scene, HapticEffect.ExposureGuard));
            Add(called, "delay", scene.Outputs.Count(output => output.Processing.DelayMilliseconds > 0f),
                "output", Cost(scene, HapticEffect.Delay));
            return called;
        }

        /// <summary>Of surfaces, and of the colliders that rules give a material.</summary>
        private static IEnumerable<MaterialDescription> Descriptions(SceneContents scene) => scene.Surfaces
            .Select(surface => surface.SharedDescription)
            .Concat(scene.Answers.Where(answer => answer.Surface is null && answer.CanBeFelt)
                .Select(answer => answer.ByRules.Parts.First(part => part.CanBeFelt).Material?.Description)
                .Where(description => description != null).Select(description => description!));

        private static bool HasRun(SceneContents scene) =>
            OfSurfaces.Any(each => Cost(scene, each.Effect).HasValue);

        private static void Add(List<string> called, string name, int count, string noun, double? microseconds)
        {
            if (count > 0)
            {
                string cost = microseconds.HasValue ? FormattableCost(microseconds.Value) : "";
                called.Add($"{name} ({count} {noun}{(count == 1 ? "" : "s")}{cost})");
            }
        }

        private static string FormattableCost(double microseconds) =>
            System.FormattableString.Invariant($", {microseconds:0.0} us a run");

        /// <summary>Of all styluses together, for each run on this machine; null before anything ran.</summary>
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
