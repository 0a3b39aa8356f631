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
            HapticOutput? off = SceneOutputs.Preferred(scene.SwitchedOffOutputs);
            HapticStylus[] silent = StylusPlaces.Of(scene)
                .Where(places => places.IsSilent && !places.IsNamed && places.SwitchedOff.Count == 0)
                .Select(places => places.Stylus).ToArray();
            if (off != null && silent.Length > 0)
            {
                yield return new Finding(MessageType.Warning,
                    $"The scene's Haptic Output {off.name} is switched off: " +
                    $"{string.Join(", ", silent.Select(each => each.PenName))} would play on it, and is silent.",
                    silent.Prepend<Object>(off).ToArray());
            }
            foreach (HapticStylus stylus in scene.Styluses)
            {
                HapticOutput? output = stylus.Output;
                if (output != null && !output.isActiveAndEnabled)
                {
                    yield return new Finding(MessageType.Warning,
                        $"{stylus.PenName} plays on {output.name}, which is switched off: it is silent.",
                        new Object[] { stylus, output });
                }
            }
        }
    }
}
