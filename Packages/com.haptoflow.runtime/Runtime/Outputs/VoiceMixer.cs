#nullable enable
using System;
using System.Diagnostics;
using System.Threading;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The voices of one channel. The main thread adds them; the audio thread renders them without locks and
    /// without garbage. A voice that is closed is heard until it has faded.</summary>
    internal sealed class VoiceMixer
    {
        // The main thread's: those that may be set.
        private HapticVoice[] voices = Array.Empty<HapticVoice>();

        // The audio thread's: also those that fade; 0 for one that has.
        private ulong[] sounding = Array.Empty<ulong>();

        public bool HasVoices => Array.Exists(voices, voice => IsOpen(voice));

        public void Add(HapticVoice voice)
        {
            voices = With(Array.FindAll(voices, each => IsOpen(each)), voice);
            Volatile.Write(ref sounding, With(Array.FindAll(sounding, each => each != 0), voice.Id));
        }

        /// <summary>Calls an action with every voice that is still open. Main thread.</summary>
        public void ForEach<T>(Action<HapticVoice, T> act, T argument)
        {
            foreach (HapticVoice voice in voices)
            {
                try
                {
                    if (IsOpen(voice))
                    {
                        act(voice, argument);
                    }
                }
                catch (HaptoFlowException closed) when (closed.Status == HaptoFlowStatus.InvalidArgument)
                {
                    // The engine was restarted in this frame; the stylus closes the voice in the next.
                }
            }
        }

        /// <summary>The frames that the present voices have rendered, together. Main thread.</summary>
        public ulong RenderedFrames()
        {
            ulong frames = 0UL;
            foreach (HapticVoice voice in voices)
            {
                frames += TryGetStatistics(voice, out VoiceStatistics statistics) ? statistics.RenderedFrames : 0UL;
            }
            return frames;
        }

        /// <summary>True where every voice is muted, paused, turned down to 0, silenced by a panic, or closed. Main
        /// thread.</summary>
        public bool AllAreStopped()
        {
            foreach (HapticVoice voice in voices)
            {
                if (TryGetStatistics(voice, out VoiceStatistics statistics) && !(statistics.Silence is
                    HapticSilence.Muted or HapticSilence.Paused or HapticSilence.Panic or HapticSilence.Closing or
                    HapticSilence.TurnedDown))
                {
                    return false;
                }
            }
            return true;
        }

        /// <summary>Overwrites the channel with the sum of the voices, limited to +-1. Audio thread.</summary>
        public void Render(Span<float> interleaved, int channels, int channel, int sampleRateHz)
        {
            ulong[] present = Volatile.Read(ref sounding);
            if (present.Length > 0)
            {
                HapticVoice.RenderSum(present, interleaved, channels, channel, sampleRateHz);
                return;
            }
            // Where there is no library, there are no voices either.
            for (int index = Math.Max(channel, 0); index < interleaved.Length; index += channel < 0 ? 1 : channels)
            {
                interleaved[index] = 0f;
            }
        }

        private static bool IsOpen(HapticVoice voice) => voice.Id != 0;

        private static T[] With<T>(T[] before, T added)
        {
            Array.Resize(ref before, before.Length + 1);
            before[before.Length - 1] = added;
            return before;
        }

        /// <summary>False for a voice that is closed, also by a restart of the engine in this frame.</summary>
        private static bool TryGetStatistics(HapticVoice voice, out VoiceStatistics statistics)
        {
            statistics = default;
            try
            {
                if (!IsOpen(voice))
                {
                    return false;
                }
                statistics = voice.Statistics();
                return true;
            }
            catch (HaptoFlowException closed) when (closed.Status == HaptoFlowStatus.InvalidArgument)
            {
                return false;
            }
        }
    }

    /// <summary>An output as the interface between a stylus's voice and the device. Main thread.</summary>
    internal interface IVoiceTarget
    {
        int SampleRateHz { get; }

        float Strength { get; }

        /// <summary>True while the output plays a signal instead of textures: it begins and ends with the tip's
        /// motion.</summary>
        bool PlaysSignal { get; }

        /// <summary>Renders the voice until it is closed and has faded. A voice has one output.</summary>
        void Add(HapticVoice voice);
    }

    /// <summary>Level and render time of an output's last blocks: written by the audio thread, read by any
    /// thread.</summary>
    internal sealed class OutputMeter
    {
        private const float FallPerBlock = 0.9f;

        private volatile float peak;
        private volatile float milliseconds;
        private volatile float worstMilliseconds;
        private long beganTicks;
        private volatile DeviceCheck.BlockRecorder? recorder;

        /// <summary>Peak magnitude, which decays within some blocks.</summary>
        public float Peak => peak;

        public float Milliseconds => milliseconds;

        public float WorstMilliseconds => worstMilliseconds;

        /// <summary>Records every block; null for none. Main thread.</summary>
        public DeviceCheck.BlockRecorder? Recorder
        {
            set => recorder = value;
        }

        public void Begin()
        {
            recorder?.Begin();
            beganTicks = Stopwatch.GetTimestamp();
        }

        public void End(ReadOnlySpan<float> samples, int channels, int channel)
        {
            milliseconds = (float)((Stopwatch.GetTimestamp() - beganTicks) * 1000.0 / Stopwatch.Frequency);
            worstMilliseconds = Math.Max(worstMilliseconds, milliseconds);
            recorder?.End(milliseconds);
            float largest = 0f;
            for (int index = Math.Max(0, channel); index < samples.Length; index += channel < 0 ? 1 : channels)
            {
                largest = Math.Max(largest, Math.Abs(samples[index]));
            }
            peak = Math.Max(largest, peak * FallPerBlock);
        }
    }
}
