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
}
