#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Finds outputs that are silent because of their settings: disabled, or without the channel that their
    /// route needs.</summary>
    internal static class SilentOutputRules
    {
        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            foreach (HapticOutput output in scene.Outputs)
            {
                if (output.Route == OutputRoute.ListenerChannel && output.Channel < 0)
                {
                    yield return new Finding(MessageType.Error,
                        $"{output.name} has the route Listener Channel and channel -1, which would overwrite all " +
                        "game audio, so nothing is felt. Choose the channel that the actuator is wired to, from " +
                        "0.", new[] { output });
                }
            }
            IReadOnlyList<HapticOutput> off = SwitchedOff();
            if (scene.Styluses.Count > 0 && scene.Outputs.Count == 0 && off.Count > 0)
            {
                yield return new Finding(MessageType.Warning,
                    $"The scene's Haptic Output {off[0].name} is switched off: styluses without an output of their " +
                    "own are silent.", off.ToArray<Object>());
            }
            foreach (HapticStylus stylus in scene.Styluses)
            {
                HapticOutput? output = stylus.Output;
                if (output != null && !output.isActiveAndEnabled)
                {
                    yield return new Finding(MessageType.Warning,
                        $"{stylus.name} plays on {output.name}, which is switched off: it is silent.",
                        new Object[] { stylus, output });
                }
            }
        }

        /// <summary>Whether the scene has an output, enabled or not. If so, play mode adds none.</summary>
        public static bool HasOutput(SceneContents scene) => scene.Outputs.Count > 0 || SwitchedOff().Count > 0;

        private static IReadOnlyList<HapticOutput> SwitchedOff() => Object
            .FindObjectsByType<HapticOutput>(FindObjectsInactive.Include, FindObjectsSortMode.None)
            .Where(output => !output.isActiveAndEnabled)
            .ToArray();
    }
}
