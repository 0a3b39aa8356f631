#nullable enable
using System.Collections.Generic;
using System.Globalization;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>A wave needs a way to the device, and a device that asks for it often enough.</summary>
    internal static class OutputRules
    {
        // 512 frames at 48 kHz are 10.7 ms.
        private const double LongestBlockMs = 11.0;
        private const int LowestRateHz = 8000;
        private const int HighestRateHz = 192000;

        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            if (scene.Styluses.Count > 0 && !SilentOutputRules.HasOutput(scene))
            {
                yield return new Finding(MessageType.Info,
                    "The scene has no Haptic Output: one is made at play that sounds on every channel of the device. " +
                    "Add one to choose the channel that the actuator hangs on.", null,
                    new Repair("Add an Output", AddOutput));
            }
            AudioConfiguration device = AudioSettings.GetConfiguration();
            foreach (HapticOutput output in scene.Outputs)
            {
                Finding? finding = CheckRoute(output, device);
                if (finding != null)
                {
                    yield return finding;
                }
                if (output.Processing.LacksProfile)
                {
                    yield return new Finding(MessageType.Warning,
                        $"{output.name} is to be compensated by an actuator profile and names none: it plays " +
                        "uncompensated.", new[] { output });
                }
            }
            foreach (Finding finding in CheckDevice(device))
            {
                yield return finding;
            }
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
                        $"{output.name} goes through a mixer effect and names no mixer: nothing is felt.", objects);
            }
            if (output.Route == OutputRoute.ListenerChannel && !output.TryGetComponent(out AudioListener _))
            {
                return new Finding(MessageType.Error,
                    $"{output.name} overwrites a channel of the listener and is not on an Audio Listener's object: " +
                    "nothing is felt. Move it there, below every other filter.", objects);
            }
            int channels = ChannelsOf(device.speakerMode);
            return output.Channel < channels
                ? null
                : new Finding(MessageType.Warning,
                    $"{output.name} plays on channel {output.Channel}, counted from 0, and the project's speaker " +
                    $"mode has {channels}: it is silent unless the device has more.", objects,
                    new Repair("Open Audio Settings", OpenAudioSettings));
        }

        private static IEnumerable<Finding> CheckDevice(AudioConfiguration device)
        {
            if (device.sampleRate < LowestRateHz || device.sampleRate > HighestRateHz)
            {
                yield return new Finding(MessageType.Error, string.Format(CultureInfo.InvariantCulture,
                    "The audio device runs at {0} Hz; haptics need {1} to {2} Hz.",
                    device.sampleRate, LowestRateHz, HighestRateHz),
                    null, new Repair("Open Audio Settings", OpenAudioSettings));
                yield break;
            }
            double blockMs = 1000.0 * device.dspBufferSize / device.sampleRate;
            if (blockMs > LongestBlockMs)
            {
                yield return new Finding(MessageType.Info, string.Format(CultureInfo.InvariantCulture,
                    "The audio device asks for {0} frames at a time, {1:0} ms at {2} Hz, which touches wait for. " +
                    "DSP Buffer Size: Best Latency is felt sooner.",
                    device.dspBufferSize, blockMs, device.sampleRate),
                    null, new Repair("Open Audio Settings", OpenAudioSettings));
            }
        }

        private static int ChannelsOf(AudioSpeakerMode mode) => mode switch
        {
            AudioSpeakerMode.Mono => 1,
            AudioSpeakerMode.Quad => 4,
            AudioSpeakerMode.Surround => 5,
            AudioSpeakerMode.Mode5point1 => 6,
            AudioSpeakerMode.Mode7point1 => 8,
            _ => 2,
        };

        private static void AddOutput()
        {
            var owner = new GameObject("Haptic Output");
            owner.AddComponent<HapticOutput>();
            Undo.RegisterCreatedObjectUndo(owner, "Add an Output");
            Selection.activeObject = owner;
        }

        private static void OpenAudioSettings() => SettingsService.OpenProjectSettings("Project/Audio");
    }
}
