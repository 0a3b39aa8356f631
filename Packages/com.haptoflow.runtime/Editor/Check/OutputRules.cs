#nullable enable
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Checks that every output has a route to the audio device, and that the device runs at a usable rate and
    /// block size.</summary>
    internal static class OutputRules
    {
        /// <summary>The lowest sample rate of an audio device that the native library supports.</summary>
        public const int MinimumRateHz = 8000;

        /// <summary>The highest sample rate of an audio device that the native library supports.</summary>
        public const int MaximumRateHz = 192000;

        // 512 frames at 48 kHz last 10.7 ms.
        private const double MaximumBlockMs = 11.0;

        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            HapticStylus[] made = StylusPlaces.Of(scene).Where(places => places.GetsMadeOutput && !places.UsesHand)
                .Select(places => places.Stylus).ToArray();
            if (made.Length > 0)
            {
                yield return new Finding(MessageType.Info,
                    $"The scene has no Haptic Output for {string.Join(", ", made.Select(each => each.PenName))}: play " +
                    "mode adds one that plays on every channel of the device. Add one to choose the channel that the " +
                    "actuator is wired to.", made,
                    new Repair("Add an Output", () => CreateMenu.CreateOutput(new MenuCommand(null))));
            }
            AudioConfiguration device = AudioSettings.GetConfiguration();
            foreach (HapticOutput output in scene.Outputs)
            {
                Finding? finding = CheckRoute(output, device);
                if (finding != null)
                {
                    yield return finding;
                }
                if (output.Processing.ListensInVain(output))
                {
                    yield return new Finding(MessageType.Warning,
                        $"{output.name} has Listen switched on, but an actuator or a channel of its own is chosen, so " +
                        "Listen has no effect: it is for ears, and far too strong for an actuator. Switch it off; for " +
                        "loudspeakers choose Audio Source, channel -1 and Uncompensated instead.", new[] { output });
                }
                if (output.Processing.LacksProfile)
                {
                    yield return new Finding(MessageType.Warning,
                        $"{output.name} compensates by an actuator profile, but its field Actuator Profile is empty: " +
                        "it plays uncompensated. Choose a profile.", new[] { output });
                }
            }
            if (ProjectAudio.IsDisabled())
            {
                yield return UnityAudioIsOff(scene, made);
                yield break;
            }
            foreach (Finding finding in CheckDevice(device))
            {
                yield return finding;
            }
        }

        private static Finding UnityAudioIsOff(SceneContents scene, HapticStylus[] withMadeOutput)
        {
            Object[] silent = scene.Outputs.Concat<Object>(withMadeOutput).ToArray();
            return new Finding(silent.Length > 0 ? MessageType.Error : MessageType.Info,
                "Project Settings > Audio > Disable Unity Audio is on, as FMOD and Wwise ask for, so nothing can be felt " +
                "through Unity's sound output. Outputs that vibrate in a hand work; switch the setting off for an " +
                "actuator on a sound output.",
                silent, new Repair("Open Audio Settings", OpenAudioSettings));
        }

        private static Finding? CheckRoute(HapticOutput output, in AudioConfiguration device)
        {
            var objects = new[] { output };
            if (output.Route == OutputRoute.MixerEffect)
            {
                using var serialized = new SerializedObject(output);
                return serialized.FindProperty("audioMixer").objectReferenceValue != null
                    ? null
                    : new Finding(MessageType.Error,
                        $"{output.name} has the route Mixer Effect, but its field Audio Mixer is empty: nothing is " +
                        "felt. Choose the mixer.", objects);
            }
            if (output.Route == OutputRoute.ListenerChannel && !output.TryGetComponent(out AudioListener _))
            {
                return new Finding(MessageType.Error,
                    $"{output.name} has the route Listener Channel, but its object has no Audio Listener: nothing is " +
                    "felt. Move it to the Audio Listener's object.", objects);
            }
            int channels = SpeakerChannels.Count(device.speakerMode);
            return output.Channel < channels
                ? null
                : new Finding(MessageType.Warning,
                    $"{output.name} plays on channel {output.Channel}, counted from 0, but the project's speaker " +
                    $"mode has only {channels} channels: it is silent unless the device has more.", objects,
                    new Repair("Open Audio Settings", OpenAudioSettings));
        }

        private static IEnumerable<Finding> CheckDevice(AudioConfiguration device)
        {
            if (device.sampleRate < MinimumRateHz || device.sampleRate > MaximumRateHz)
            {
                yield return new Finding(MessageType.Error, string.Format(CultureInfo.InvariantCulture,
                    "The audio device runs at {0} Hz; haptics need {1} to {2} Hz.",
                    device.sampleRate, MinimumRateHz, MaximumRateHz),
                    null, new Repair("Open Audio Settings", OpenAudioSettings));
                yield break;
            }
            double blockMs = 1000.0 * device.dspBufferSize / device.sampleRate;
            if (blockMs > MaximumBlockMs)
            {
                yield return new Finding(MessageType.Info, string.Format(CultureInfo.InvariantCulture,
                    "The audio device plays blocks of {0} frames, {1:0} ms at {2} Hz, which delays every touch. DSP " +
                    "Buffer Size: Best Latency shortens them.",
                    device.dspBufferSize, blockMs, device.sampleRate),
                    null, new Repair("Open Audio Settings", OpenAudioSettings));
            }
        }

        private static void OpenAudioSettings() => SettingsService.OpenProjectSettings("Project/Audio");
    }

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
                    Repair.ChooseHand(output));
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
    }
}
