#nullable enable
using System;
using HaptoFlow.Outputs;
using HaptoFlow.Preview;
using HaptoFlow.Recordings;
using UnityEngine;

namespace HaptoFlow.Editor
{
    internal enum FeltDevice
    {
        None = 0,
        LeftHand = 1,
        RightHand = 2,
        Gamepad = 3,
    }

    /// <summary>Plays a sound on a connected device, at the default level of a scene's outputs. Main thread.</summary>
    internal sealed class FeltPlayback
    {
        private const double SearchIntervalSeconds = 0.5;

        // Outputs of a scene that plays leave the device to the preview: longer than the longest frame.
        private const float YieldSeconds = 0.25f;

        private readonly SoundWave wave = new SoundWave();
        private readonly HeldDevice held = new HeldDevice();
        private FeltDevice device;
        private int routes;
        private double nextSearchSeconds;

        public FeltDevice Device
        {
            get => device;
            set
            {
                if (value != device)
                {
                    Close();
                    device = value;
                    nextSearchSeconds = 0.0;
                }
            }
        }

        /// <summary>True while a sound plays, with or without a device.</summary>
        public bool IsPlaying => !wave.IsStopped;

        /// <summary>Position in the sound, as for <see cref="PreviewSpeaker.PositionSamples"/>.</summary>
        public int PositionSamples => wave.PositionSamples;

        /// <summary>What plays, for people; empty where nothing was chosen.</summary>
        public string Remark
        {
            get
            {
                if (device == FeltDevice.None)
                {
                    return "";
                }
                if (!held.IsThere)
                {
                    return device == FeltDevice.Gamepad
                        ? GamepadSinks.IsSupported ? "no gamepad is connected" : "needs the package Input System"
                        : Application.isPlaying ? "no haptic device in this hand" : "found in Play mode only";
                }
                string form = held.Form == HapticForm.Waveform ? "waveform" : "envelope";
                long gaps = held.Queue!.Statistics.Gaps;
                return $"{held.Sink!.Name}, {form}" + (gaps > 0 ? $", {gaps} gaps" : "");
            }
        }

        public void Play(PreviewSound sound, int startSample, bool loops) => wave.Play(sound, startSample, loops);

        public void Stop()
        {
            wave.Stop();
            held.Flush();
        }

        /// <summary>Call this at each editor update.</summary>
        /// <param name="heardSample">Position of the same sound in the speakers; null where they do not play.</param>
        public void Step(int? heardSample)
        {
            if (device == FeltDevice.None)
            {
                return;
            }
            double now = Time.realtimeSinceStartupAsDouble;
            if (now >= nextSearchSeconds)
            {
                nextSearchSeconds = now + SearchIntervalSeconds;
                Search();
            }
            if (heardSample is { } heard)
            {
                wave.Follow(heard);
            }
            if (IsPlaying && device != FeltDevice.Gamepad)
            {
                Haptics.Yield(Hand, YieldSeconds);
            }
            if (held.Queue is { } queue)
            {
                HaptoFlowSettings? settings = ProjectSettingsAsset.Find();
                queue.Ceiling = settings != null ? settings.Ceiling : 1f;
                queue.Update(now);
            }
        }

        public void Close()
        {
            held.Close();
            routes = 0;
        }

        private HapticHand Hand => device == FeltDevice.LeftHand ? HapticHand.Left : HapticHand.Right;

        private void Search()
        {
            // Play mode registers routes.
            int present = HapticSinks.Names().Count;
            if (!held.HasSinks || routes != present)
            {
                Close();
                routes = present;
                if (device == FeltDevice.Gamepad)
                {
                    GamepadSinks.Open(held);
                }
                else
                {
                    HapticSinks.OpenBest(Hand, held);
                }
            }
            if (held.Find(wave))
            {
                held.Queue!.TrueLevel = false;
                held.Queue.FullScaleMps2 = PreviewSound.FullScaleMps2;
            }
        }
    }

    /// <summary>A sound as the wave of a device's queue, at the queue's rate. Main thread.</summary>
    internal sealed class SoundWave : IWaveSource
    {
        // The speakers report their position in steps of a block, some 20 ms.
        private const int ToleratedSamples = PreviewSound.RateHz / 20;
        private const int Step = (int)(PreviewSound.RateHz / WaveHistory.RateHz);

        private PreviewSound? sound;

        // At the queue's rate; made when a device first asks for it.
        private float[]? wave;
        private bool loops;

        /// <summary>Position in the sound at its own rate.</summary>
        public int PositionSamples { get; private set; }

        public bool IsStopped => sound == null;

        /// <summary>Plays a sound in place of the present one.</summary>
        /// <param name="startSample">Start position; a position past the end counts as 0.</param>
        public void Play(PreviewSound next, int startSample, bool repeats)
        {
            sound = next.Samples.Length > 0 ? next : null;
            wave = null;
            loops = repeats;
            PositionSamples = startSample < next.Samples.Length ? startSample : 0;
        }

        public void Stop()
        {
            sound = null;
            PositionSamples = 0;
        }

        /// <summary>Continues at another position of the sound if the present one is far from it.</summary>
        public void Follow(int sample)
        {
            if (sound == null)
            {
                return;
            }
            int apart = Math.Abs(sample - PositionSamples);
            int shortest = loops ? Math.Min(apart, sound.Samples.Length - apart) : apart;
            if (shortest > ToleratedSamples && sample < sound.Samples.Length)
            {
                PositionSamples = sample;
            }
        }

        public void Render(Span<float> samples)
        {
            for (int index = 0; index < samples.Length; ++index)
            {
                samples[index] = sound != null ? Next(sound) : 0f;
            }
        }

        private float Next(PreviewSound playing)
        {
            wave ??= Waves.Resampled(playing.Samples, PreviewSound.RateHz, WaveHistory.RateHz);
            float sample = wave[Math.Min(PositionSamples / Step, wave.Length - 1)];
            PositionSamples += Step;
            if (PositionSamples >= playing.Samples.Length)
            {
                PositionSamples = loops ? PositionSamples - playing.Samples.Length : 0;
                sound = loops ? sound : null;
            }
            return sample;
        }
    }
}
