#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Checks that it is clear what plays each stylus, and that outputs do not interrupt each other.</summary>
    internal static class PlaceRules
    {
        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            IReadOnlyList<StylusPlaces> all = StylusPlaces.Of(scene);
            return all.Where(places => places.IsSilent && places.SwitchedOff.Count > 0).Select(SwitchedOff)
                .Concat(CheckChoice(scene, all))
                .Concat(CheckMixers(all))
                .Concat(CheckHands(all))
                .Concat(scene.DeviceOutputs.SelectMany(CheckDevice));
        }

        private static Finding SwitchedOff(StylusPlaces places)
        {
            DeviceOutput output = places.SwitchedOff[0];
            return new Finding(MessageType.Warning,
                $"{places.Stylus.PenName} is silent: {StylusPlaces.NameOf(output)} is switched off, and no device is " +
                "chosen automatically beside it. Switch it on or remove it.",
                new Object[] { places.Stylus, output });
        }

        /// <summary>Finds styluses for which the order of waking decides between outputs.</summary>
        private static IEnumerable<Finding> CheckChoice(SceneContents scene, IReadOnlyList<StylusPlaces> all)
        {
            HapticOutput[] equal = scene.Outputs
                .Where(output => output.HasOwnChannel == SceneOutputs.Preferred(scene.Outputs)!.HasOwnChannel).ToArray();
            if (equal.Length < 2)
            {
                yield break;
            }
            foreach (StylusPlaces places in all.Where(each => !each.IsNamed && !each.UsesHand))
            {
                yield return new Finding(MessageType.Warning,
                    $"{places.Stylus.PenName} names no output, and the scene has {equal.Length} that could play it: " +
                    $"{string.Join(", ", equal.Select(output => $"{output.name} {Channel(output)}"))}. The one that wakes first does.",
                    equal.Prepend<Object>(places.Stylus).ToArray(),
                    equal.Select(output => new Repair($"Play on {output.name} {Channel(output)}",
                        () => Play(places.Stylus, output))).ToArray());
            }
        }

        private static IEnumerable<Finding> CheckMixers(IReadOnlyList<StylusPlaces> all) => all
            .Where(places => places.Audio != null && places.Audio.Route == OutputRoute.MixerEffect)
            .GroupBy(places => places.Audio!)
            .Where(group => group.Count() > 1)
            .Select(group => new Finding(MessageType.Warning,
                $"{Names(group)} play on {group.Key.name}, but the route Mixer Effect plays one stylus: only the " +
                "last one that wakes is felt. Give each an output with a parameter of its own.",
                group.Select(places => (Object)places.Stylus).Append(group.Key).ToArray()));

        private static IEnumerable<Finding> CheckHands(IReadOnlyList<StylusPlaces> all) => all
            .SelectMany(places => HandsOf(places).Select(hand => (hand, places)))
            .GroupBy(each => each.hand, each => each.places)
            .Where(group => group.Count() > 1)
            .Select(group => new Finding(MessageType.Warning,
                $"{Names(group)} are felt through the same device in the {group.Key.InWords()} hand: each " +
                "interrupts the other when both touch. Keep one of them, or give one the other hand.",
                group.Select(places => (Object)places.Stylus).ToArray()));

        private static IEnumerable<Finding> CheckDevice(DeviceOutput output)
        {
            string name = StylusPlaces.NameOf(output);
            if (output.Played == null)
            {
                yield return new Finding(MessageType.Warning,
                    $"{name} has no stylus: it plays nothing. Put it on a stylus, or choose one in its field Stylus.",
                    new[] { output }, ChildOf(output));
            }
            else if (StylusPlaces.HandOf(output) == HapticHand.None)
            {
                yield return new Finding(MessageType.Warning,
                    $"{name} has no hand, and neither has its stylus: no device is found.", new[] { output },
                    new Repair("Right Hand", () => SetHand(output, HapticHand.Right)),
                    new Repair("Left Hand", () => SetHand(output, HapticHand.Left)));
            }
            if (output is ControllerParametricOutput parametric && !parametric.UseExperimentalFeature)
            {
                yield return new Finding(MessageType.Warning,
                    $"{name} is silent while Use Experimental Feature is off. Meta's store accepts no application " +
                    "that uses it; a Controller Waveform Output needs no such feature.", new[] { output });
            }
        }

        /// <summary>An output on a pen's object instead of on its stylus: the stylus is below.</summary>
        private static Repair[] ChildOf(DeviceOutput output)
        {
            HapticStylus below = output.GetComponentInChildren<HapticStylus>(true);
            return below == null
                ? new Repair[0]
                : new[] { new Repair($"Play {below.PenName}", () => SerializedFields.Set(output, "stylus",
                    property => property.objectReferenceValue = below)) };
        }

        private static IEnumerable<HapticHand> HandsOf(StylusPlaces places) => places.UsesHand
            ? new[] { places.Hand }
            : places.Devices.Select(StylusPlaces.HandOf).Where(hand => hand != HapticHand.None).Distinct();

        private static string Names(IEnumerable<StylusPlaces> group) =>
            string.Join(" and ", group.Select(places => places.Stylus.PenName));

        private static string Channel(HapticOutput output) => output.Route == OutputRoute.MixerEffect
            ? "(mixer)" : output.Channel < 0 ? "(all channels)" : $"(channel {output.Channel})";

        private static void Play(HapticStylus stylus, HapticOutput output) =>
            SerializedFields.Set(stylus, "output", property => property.objectReferenceValue = output);

        private static void SetHand(DeviceOutput output, HapticHand hand) =>
            SerializedFields.Set(output, "hand", property => property.enumValueIndex = (int)hand);
    }
}
