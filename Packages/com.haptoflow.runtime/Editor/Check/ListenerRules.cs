#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Checks outputs on the object of an Audio Listener: whether the route makes use of it, and whether a
    /// filter below an exclusive channel changes that channel.</summary>
    internal static class ListenerRules
    {
        private const BindingFlags Anything =
            BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.DeclaredOnly;

        public static IEnumerable<Finding> Check(HapticOutput output)
        {
            if (!output.TryGetComponent(out AudioListener _))
            {
                yield break;
            }
            if (output.Route == OutputRoute.AudioSource)
            {
                yield return new Finding(MessageType.Info,
                    $"{output.name} has an Audio Listener and a Haptic Output with the route Audio Source: while the " +
                    "scene plays, the sound comes from a child object, because a filter here would overwrite what " +
                    "the listener hears. Choose the route Listener Channel for a channel that carries nothing " +
                    "else, or put the output on an object of its own.", new[] { output });
            }
            Component[] below = output.Route == OutputRoute.ListenerChannel ? FiltersBelow(output) : new Component[0];
            if (below.Length > 0)
            {
                yield return new Finding(MessageType.Warning,
                    $"{output.name} overwrites a channel of the Audio Listener, but these filters come after it and " +
                    $"change that channel: {string.Join(", ", below.Select(NameOf))}. Move the Haptic Output below them.",
                    new Object[] { output });
            }
        }

        private static Component[] FiltersBelow(HapticOutput output)
        {
            var all = new List<Component>();
            output.GetComponents(all);
            return all.SkipWhile(each => each != output).Skip(1)
                .Where(each => each is Behaviour filter && filter.enabled && IsFilter(each.GetType())).ToArray();
        }

        // Unity's own filters are AudioLowPassFilter and the like; a script is one by its method.
        private static bool IsFilter(Type? type)
        {
            bool isUnitys = type != null && type.Namespace == nameof(UnityEngine) &&
                type.Name.StartsWith("Audio", StringComparison.Ordinal) &&
                type.Name.EndsWith("Filter", StringComparison.Ordinal);
            for (; !isUnitys && type != null && type != typeof(MonoBehaviour); type = type.BaseType)
            {
                if (type.GetMethod("OnAudioFilterRead", Anything) != null)
                {
                    return true;
                }
            }
            return isUnitys;
        }

        private static string NameOf(Component filter) => ObjectNames.NicifyVariableName(filter.GetType().Name);
    }
}
