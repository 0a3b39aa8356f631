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

    /// <summary>Notices that the audio engine no longer calls an output. Main thread.</summary>
    internal struct CallWatch
    {
        private ulong knownCalls;
        private FrameTime silence;
        private bool hasTold;

        public void Restart() => this = default;

        /// <summary>True once for each silence, after a second of frames without a call.</summary>
        public bool Misses(ulong calls, bool areExpected)
        {
            if (calls != knownCalls)
            {
                Restart();
            }
            knownCalls = calls;
            if (!areExpected)
            {
                silence.Restart();
                return false;
            }
            bool tells = silence.Add() && !hasTold;
            hasTold |= tells;
            return tells;
        }
    }

    /// <summary>A second of running frames, in which the audio thread has time for several blocks. A frame counts as 0.1 s at
    /// most: after a hitch or a suspended application the audio thread is given its time again. Main thread.</summary>
    internal struct FrameTime
    {
        private const double PatienceSeconds = 1.0;
        private const double LongestFrameSeconds = 0.1;
        private double seconds;

        public void Restart() => seconds = 0.0;

        /// <summary>Adds this frame; true where the second is over, which begins again.</summary>
        public bool Add()
        {
            seconds += Math.Min(Time.unscaledDeltaTime, LongestFrameSeconds);
            bool isOver = seconds >= PatienceSeconds;
            seconds = isOver ? 0.0 : seconds;
            return isOver;
        }
    }

    /// <summary>Counts the channels of an audio device. Unity has no such count.</summary>
    internal static class SpeakerChannels
    {
        public static int Count(AudioSpeakerMode mode) => mode switch
        {
            AudioSpeakerMode.Mono => 1,
            AudioSpeakerMode.Quad => 4,
            AudioSpeakerMode.Surround => 5,
            AudioSpeakerMode.Mode5point1 => 6,
            AudioSpeakerMode.Mode7point1 => 8,
            _ => 2,
        };
    }

    /// <summary>The calls that an output gets from the audio engine: from a source on a child object of its own, which
    /// leaves the author's sources alone, or from the Audio Listener on the output's object. Main thread.</summary>
    internal sealed class AudioCalls
    {
        private readonly Action<float[], int> render;
        // Two blocks of the longest device, the first of which may have begun, and the fade.
        private const double FadeSeconds = 0.4;

        private AudioFilter? filter;
        private AudioFilter? fading;
        private AudioSource? source;

        /// <param name="render">Called on the audio thread with interleaved samples and the number of channels.</param>
        public AudioCalls(Action<float[], int> render) => this.render = render;

        /// <summary>Has everything that the engine calls made anew. Not during OnEnable: Unity then refuses to change the
        /// hierarchy.</summary>
        public void Open(GameObject owner, OutputRoute route, bool obeysVolume)
        {
            Close();
            if (route == OutputRoute.ListenerChannel)
            {
                filter = AudioFilter.AddTo(owner, render);
            }
            else if (route == OutputRoute.AudioSource)
            {
                source = MakeSource(owner);
                filter = AudioFilter.AddTo(source.gameObject, render);
                ObeyVolume(obeysVolume);
                source.Play();
            }
        }

        public void CloseAfterTheFade()
        {
            fading = filter;
            if (fading != null)
            {
                fading.RetireAfter(FadeSeconds, source);
            }
            filter = null;
            source = null;
        }

        public void Close()
        {
            if (fading != null)
            {
                fading.Retire();
            }
            fading = null;
            if (filter != null)
            {
                filter.Retire();
            }
            if (source != null)
            {
                source.Stop();
                Object.Destroy(source.gameObject);
            }
            filter = null;
            source = null;
        }

        public void ObeyVolume(bool obeys)
        {
            if (source != null)
            {
                source.ignoreListenerVolume = !obeys;
            }
        }

        private static AudioSource MakeSource(GameObject owner)
        {
            var child = new GameObject("HaptoFlow Source");
            child.transform.SetParent(owner.transform, false);
            var made = child.AddComponent<AudioSource>();
            made.playOnAwake = false;
            made.spatialBlend = 0f;
            made.priority = 0;
            made.dopplerLevel = 0f;
            made.bypassReverbZones = true;
            made.bypassListenerEffects = true;
            // The output pauses its voices, which fade out; a paused source would cut them off.
            made.ignoreListenerPause = true;
            return made;
        }
    }
}
