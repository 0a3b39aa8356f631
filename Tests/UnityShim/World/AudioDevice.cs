using System;
using System.Threading;
using UnityEngine;

namespace UnityShim
{
    /// <summary>The audio output. Its own thread pulls blocks through the filters of playing sources and of the
    /// listener, for as much time as the frames last. The main thread waits for it, so that tests are reproducible.
    /// </summary>
    public static class AudioDevice
    {
        private const int RecordedSeconds = 60;
        private static readonly SemaphoreSlim BlockRequested = new SemaphoreSlim(0);
        private static readonly SemaphoreSlim Done = new SemaphoreSlim(0);
        private static Thread? thread;
        private static AudioConfiguration configuration;
        private static double owedFrames;
        private static long playedFrames;
        private static float[] mix = Array.Empty<float>();
        private static float[] pastListener = Array.Empty<float>();
        private static float[] source = Array.Empty<float>();
        private static float[] recorded = Array.Empty<float>();

        public static event AudioSettings.AudioConfigurationChangeHandler? ConfigurationChanged;

        public static AudioConfiguration Configuration => configuration;

        /// <summary>Whether a change of the device leaves earlier filters without calls, as reported of Unity on macOS and
        /// Android (livekit/client-sdk-unity, pull requests 274 and 311).</summary>
        public static bool DetachesFilters { get; set; }

        /// <summary>Whether a change of the device leaves earlier sources unheard (decentraland/unity-explorer, pull
        /// request 8590).</summary>
        public static bool DetachesSources { get; set; }

        /// <summary>Whether the project disables Unity's audio, as a player behaves then: no clock, no rate, no blocks.
        /// </summary>
        public static bool IsSwitchedOff { get; set; }

        /// <summary>Whether no block is asked for and the clock stands still, as without an audio device.</summary>
        public static bool StandsStill { get; set; }

        /// <summary>Whether sources play on request. In the editor they do not where the project disables Unity's audio,
        /// although the audio's clock advances.</summary>
        public static bool IgnoresPlay { get; set; }

        /// <summary>The number of times that the audio graph was rebuilt.</summary>
        internal static int Generation { get; private set; }

        internal static double DspSeconds => IsSwitchedOff ? 0.0 : (double)playedFrames / configuration.sampleRate;

        public static int Channels => configuration.speakerMode == AudioSpeakerMode.Mono ? 1
            : configuration.speakerMode == AudioSpeakerMode.Quad ? 4 : 2;

        /// <summary>The number of interleaved frames played since play mode began or <see cref="Forget"/> was called.
        /// </summary>
        public static int RecordedFrames { get; private set; }

        /// <summary>The number of bytes that the filters allocated on the audio thread.</summary>
        public static long AllocatedBytes { get; private set; }

        public static Exception? Failure { get; private set; }

        public static float Sample(int frame, int channel) => recorded[frame * Channels + channel];

        /// <summary>A channel of the recorded frames.</summary>
        public static float[] Samples(int channel = 0)
        {
            var samples = new float[RecordedFrames];
            for (int frame = 0; frame < samples.Length; ++frame)
            {
                samples[frame] = Sample(frame, channel);
            }
            return samples;
        }

        /// <summary>The largest magnitude from a frame up to another, or to the last.</summary>
        public static float Peak(int channel = 0, int from = 0, int to = int.MaxValue)
        {
            float peak = 0f;
            for (int frame = from; frame < Math.Min(to, RecordedFrames); ++frame)
            {
                peak = Math.Max(peak, Math.Abs(Sample(frame, channel)));
            }
            return peak;
        }

        public static void Forget()
        {
            RecordedFrames = 0;
            AllocatedBytes = 0;
        }

        /// <summary>Changes sample rate, block size or channel count, as plugging in headphones does.</summary>
        public static void ChangeDevice(int sampleRateHz, int blockFrames, AudioSpeakerMode mode) => Restart(
            new AudioConfiguration { sampleRate = sampleRateHz, dspBufferSize = blockFrames, speakerMode = mode }, true);

        /// <summary>Calls no filter any more that exists now, without telling scripts.</summary>
        public static void DropAll()
        {
            DetachesFilters = true;
            ++Generation;
        }

        internal static void Reset()
        {
            configuration = new AudioConfiguration
            {
                sampleRate = 48000,
                dspBufferSize = 512,
                speakerMode = AudioSpeakerMode.Stereo,
            };
            AudioListener.volume = 1f;
            AudioListener.pause = false;
            DetachesFilters = false;
            DetachesSources = false;
            IsSwitchedOff = false;
            StandsStill = false;
            IgnoresPlay = false;
            playedFrames = 0;
            Prepare();
            Forget();
            Failure = null;
        }

        internal static void Restart(AudioConfiguration changed, bool deviceWasChanged)
        {
            configuration = changed;
            ++Generation;
            Prepare();
            foreach (GameObject gameObject in World.AllObjects)
            {
                if (gameObject.TryGetComponent(out AudioSource playing))
                {
                    playing.Playing = false;
                }
            }
            ConfigurationChanged?.Invoke(deviceWasChanged);
        }

        internal static void Advance(double seconds)
        {
            if (IsSwitchedOff || StandsStill)
            {
                return;
            }
            owedFrames += seconds * configuration.sampleRate;
            while (owedFrames >= configuration.dspBufferSize)
            {
                owedFrames -= configuration.dspBufferSize;
                // A paused listener freezes the audio clock.
                playedFrames += AudioListener.pause ? 0 : configuration.dspBufferSize;
                RunBlock();
            }
        }

        private static void Prepare()
        {
            owedFrames = 0.0;
            mix = new float[configuration.dspBufferSize * Channels];
            pastListener = new float[configuration.dspBufferSize * Channels];
            source = new float[configuration.dspBufferSize * Channels];
            recorded = new float[RecordedSeconds * configuration.sampleRate * Channels];
            RecordedFrames = 0;
        }

        private static void RunBlock()
        {
            if (thread == null)
            {
                thread = new Thread(Serve) { IsBackground = true, Name = "Audio" };
                thread.Start();
            }
            BlockRequested.Release();
            Done.Wait();
            int room = recorded.Length / Channels - RecordedFrames;
            int frames = Math.Min(room, configuration.dspBufferSize);
            Array.Copy(mix, 0, recorded, RecordedFrames * Channels, frames * Channels);
            RecordedFrames += frames;
        }

        private static void Serve()
        {
            while (true)
            {
                BlockRequested.Wait();
                long before = GC.GetAllocatedBytesForCurrentThread();
                try
                {
                    Render();
                }
                catch (Exception error)
                {
                    Failure = error;
                }
                AllocatedBytes += GC.GetAllocatedBytesForCurrentThread() - before;
                Done.Release();
            }
        }

        private static void Render()
        {
            Array.Clear(mix, 0, mix.Length);
            Array.Clear(pastListener, 0, pastListener.Length);
            GameObject? listener = null;
            for (int index = 0; index < World.AllObjects.Count; ++index)
            {
                GameObject gameObject = World.AllObjects[index];
                if (gameObject.TryGetComponent(out AudioSource playing) && playing.isPlaying &&
                    (!DetachesSources || playing.Generation == Generation) &&
                    (!AudioListener.pause || playing.ignoreListenerPause))
                {
                    float volume = playing.ignoreListenerVolume ? 1f : AudioListener.volume;
                    Array.Clear(source, 0, source.Length);
                    if (!playing.bypassEffects)
                    {
                        RunFilters(gameObject, source);
                    }
                    float[] into = playing.bypassListenerEffects ? pastListener : mix;
                    for (int sample = 0; sample < into.Length; ++sample)
                    {
                        into[sample] += volume * playing.volume * source[sample];
                    }
                }
                if (gameObject.TryGetComponent(out AudioListener ears) && ears.isActiveAndEnabled)
                {
                    listener = gameObject;
                }
            }
            if (listener is not null)
            {
                RunFilters(listener, mix);
                for (int sample = 0; sample < mix.Length; ++sample)
                {
                    mix[sample] += pastListener[sample];
                }
            }
            else
            {
                Array.Clear(mix, 0, mix.Length);
            }
        }

        /// <summary>The filters of an object, in the order of its components.</summary>
        private static void RunFilters(GameObject gameObject, float[] samples)
        {
            for (int component = 0; component < gameObject.Components.Count; ++component)
            {
                for (int index = 0; index < World.AllScripts.Count; ++index)
                {
                    if (ReferenceEquals(World.AllScripts[index].Script, gameObject.Components[component]))
                    {
                        World.AllScripts[index].AudioFilter?.Invoke(samples, Channels);
                    }
                }
            }
        }
    }
}
