#nullable enable
using System;
using System.Threading;

namespace HaptoFlow
{
    /// <summary>The voices of one channel. The main thread adds and removes voices; the audio thread renders them
    /// without locks and without garbage.</summary>
    internal sealed class VoiceMixer
    {
        private HapticVoice[] voices = Array.Empty<HapticVoice>();
        private float[] scratch = Array.Empty<float>();

        /// <summary>True where there is something to render.</summary>
        public bool HasVoices => voices.Length > 0;

        /// <summary>Allocates for blocks of this length. Call it before the audio thread renders them. Main
        /// thread.</summary>
        public void Prepare(int blockFrames)
        {
            if (Volatile.Read(ref scratch).Length < blockFrames)
            {
                Volatile.Write(ref scratch, new float[blockFrames]);
            }
        }

        public void Add(HapticVoice voice)
        {
            HapticVoice[] before = voices;
            var after = new HapticVoice[before.Length + 1];
            before.CopyTo(after, 0);
            after[before.Length] = voice;
            Volatile.Write(ref voices, after);
        }

        public void Remove(HapticVoice voice) =>
            Volatile.Write(ref voices, Array.FindAll(voices, each => !ReferenceEquals(each, voice)));

        /// <summary>Calls an action with every voice that is still open. Main thread.</summary>
        public void ForEach<T>(Action<HapticVoice, T> act, T argument)
        {
            foreach (HapticVoice voice in voices)
            {
                try
                {
                    act(voice, argument);
                }
                catch (HaptoFlowException closed) when (closed.Status == HaptoFlowStatus.InvalidArgument)
                {
                    // The engine was restarted in this frame; the stylus removes the voice in the next.
                }
            }
        }

        /// <summary>The frames that the present voices have rendered, together. Main thread.</summary>
        public ulong RenderedFrames()
        {
            ulong frames = 0UL;
            foreach (HapticVoice voice in voices)
            {
                frames += FramesOf(voice);
            }
            return frames;
        }

        /// <summary>True where every voice is muted, paused, turned down to 0, silenced by a panic, or closing. Main
        /// thread.</summary>
        public bool AllAreStopped()
        {
            foreach (HapticVoice voice in voices)
            {
                if (!IsStopped(voice))
                {
                    return false;
                }
            }
            return true;
        }

        /// <summary>Overwrites the channel with the sum of the voices, limited to +-1. Audio thread.</summary>
        public void Render(Span<float> interleaved, int channels, int channel, int sampleRateHz)
        {
            HapticVoice[] sounding = Volatile.Read(ref voices);
            if (sounding.Length == 0)
            {
                Silence(interleaved, channels, channel);
                return;
            }
            sounding[0].Render(interleaved, channels, channel, sampleRateHz);
            float[] room = Volatile.Read(ref scratch);
            for (int index = 1; index < sounding.Length; ++index)
            {
                Span<float> samples = room.AsSpan(0, Math.Min(room.Length, interleaved.Length / channels));
                sounding[index].Render(samples, 1, 0, sampleRateHz);
                AddTo(interleaved, channels, channel, samples);
            }
        }

        private static ulong FramesOf(HapticVoice voice)
        {
            try
            {
                return voice.Statistics().RenderedFrames;
            }
            catch (HaptoFlowException closed) when (closed.Status == HaptoFlowStatus.InvalidArgument)
            {
                return 0UL;
            }
        }

        private static bool IsStopped(HapticVoice voice)
        {
            try
            {
                HapticSilence silence = voice.Statistics().Silence;
                return silence == HapticSilence.Muted || silence == HapticSilence.Paused ||
                    silence == HapticSilence.Panic || silence == HapticSilence.Closing ||
                    silence == HapticSilence.TurnedDown;
            }
            catch (HaptoFlowException closed) when (closed.Status == HaptoFlowStatus.InvalidArgument)
            {
                return true;
            }
        }

        private static void Silence(Span<float> interleaved, int channels, int channel)
        {
            int first = Math.Max(0, channel);
            int last = channel < 0 ? channels - 1 : channel;
            for (int frame = 0; frame < interleaved.Length / channels; ++frame)
            {
                interleaved.Slice(frame * channels + first, last - first + 1).Clear();
            }
        }

        private static void AddTo(Span<float> interleaved, int channels, int channel, ReadOnlySpan<float> samples)
        {
            int first = Math.Max(0, channel);
            int last = channel < 0 ? channels - 1 : channel;
            for (int frame = 0; frame < samples.Length; ++frame)
            {
                for (int place = first; place <= last; ++place)
                {
                    ref float sample = ref interleaved[frame * channels + place];
                    sample = Math.Max(-1f, Math.Min(1f, sample + samples[frame]));
                }
            }
        }
    }
}
