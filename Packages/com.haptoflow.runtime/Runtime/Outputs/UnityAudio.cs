#nullable enable
using System;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow
{
    /// <summary>Whether Unity's own audio runs: projects with FMOD or Wwise switch it off. Unity does not say so in players,
    /// but its audio clock then stands still. Main thread.</summary>
    internal static class UnityAudio
    {
        private static int polledFrame = -1;
        private static double clockSeconds;
        private static FrameTime stillFor;
        private static bool saidOff;
        private static bool? isDisabled;

        /// <summary>Whether the project disables Unity's audio. Set by the editor, where the audio clock goes on
        /// nevertheless; null in players.</summary>
        public static Func<bool>? IsDisabledByProject { get; set; }

        /// <summary>Why nothing can play on the audio device, for a sentence; null where Unity's audio runs.</summary>
        public static string? Problem { get; private set; }

        /// <summary>The rate of the audio device, in Hz; 48000 where Unity's audio does not run.</summary>
        public static int RateHz => AudioSettings.outputSampleRate > 0 ? AudioSettings.outputSampleRate : 48000;

        /// <summary>Looks at the audio clock. Call it in every frame; further calls in a frame do nothing.</summary>
        public static void Poll()
        {
            if (Time.frameCount == polledFrame)
            {
                return;
            }
            polledFrame = Time.frameCount;
            double now = AudioSettings.dspTime;
            // A paused listener freezes the clock.
            if (!now.Equals(clockSeconds) || AudioListener.pause)
            {
                stillFor.Restart();
                Problem = IsOff() ? Problem : null;
            }
            clockSeconds = now;
            if (Problem == null && (IsOff() || stillFor.Add()))
            {
                Problem = "Unity's audio does not run, since it is switched off in Project Settings > Audio > Disable " +
                    "Unity Audio, as FMOD and Wwise ask for, or there is no audio output";
            }
        }

        /// <summary>Logs once that what plays on the audio device is silent.</summary>
        public static void SayProblem(string name, Object context)
        {
            if (!saidOff)
            {
                saidOff = true;
                Debug.LogWarning($"HaptoFlow: {name} is silent: {Problem}. Outputs that vibrate in a hand play " +
                    "all the same; for an actuator on the audio device, let Unity's audio run.", context);
            }
        }

        private static bool IsOff()
        {
            isDisabled ??= IsDisabledByProject?.Invoke() == true;
            return isDisabled.Value || AudioSettings.outputSampleRate <= 0;
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget()
        {
            polledFrame = -1;
            clockSeconds = 0.0;
            stillFor = default;
            Problem = null;
            saidOff = false;
            isDisabled = null;
        }
    }
}
