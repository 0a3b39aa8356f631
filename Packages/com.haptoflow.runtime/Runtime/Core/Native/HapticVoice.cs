#nullable enable
using System;
using System.Text;
using System.Threading;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>The signal of one stylus tip. After it is closed, <see cref="Render"/> gives silence and every other
    /// call throws; an output that plays it fades it out.</summary>
    public sealed unsafe class HapticVoice : IDisposable
    {
        /// <summary>Channel number for all channels.</summary>
        public const int AllChannels = -1;

        /// <summary>Upper limit of a signal's peak amplitude, in m/s^2.</summary>
        public const double MaximumSignalMps2 = 60.0;

        /// <summary>Lower limit of a signal's frequency, in Hz.</summary>
        public const double MinimumSignalHz = 20.0;

        /// <summary>Upper limit of a signal's frequency, in Hz.</summary>
        public const double MaximumSignalHz = 500.0;

        private long voice;

        internal HapticVoice(ulong opened) => voice = unchecked((long)opened);

        /// <summary>Closes a voice that was not disposed.</summary>
        ~HapticVoice() => Close();

        /// <summary>The library's number of the voice; 0 once it is closed.</summary>
        internal ulong Id => unchecked((ulong)Interlocked.Read(ref voice));

        /// <summary>Publishes the state of the tip. Call it once a frame, also while nothing is touched. Any thread
        /// except the audio callback; no garbage.</summary>
        /// <returns>False where another thread is publishing at the same time: this state is discarded.</returns>
        /// <exception cref="HaptoFlowException">The voice is closed.</exception>
        public bool Publish(in ContactState state)
        {
            ContactState sized = state;
            sized.StructSize = (uint)sizeof(ContactState);
            int status = NativeMethods.VoicePublish(Id, &sized);
            if (status == (int)HaptoFlowStatus.Busy)
            {
                return false;
            }
            NativeCall.Check(status);
            return true;
        }

        /// <summary>Writes the voice into one channel of interleaved samples, or into all; other channels are
        /// unchanged. For the audio callback: no garbage, no locks, no exceptions; takes microseconds.</summary>
        /// <param name="interleaved">Samples of +-1, a whole number of frames.</param>
        /// <param name="channelCount">1 to 64.</param>
        /// <param name="channel">0 to channelCount - 1, or <see cref="AllChannels"/>.</param>
        /// <returns>False where the voice was closed or busy and silence was written.</returns>
        public bool Render(Span<float> interleaved, int channelCount, int channel, double sampleRateHz)
        {
            if (channelCount < 1 || interleaved.Length < channelCount)
            {
                return false;
            }
            fixed (float* samples = interleaved)
            {
                int status = NativeMethods.VoiceRender(
                    Id, samples, (uint)(interleaved.Length / channelCount), (uint)channelCount, channel, sampleRateHz);
                return status == (int)HaptoFlowStatus.Ok;
            }
        }

        /// <summary>Writes the sum of voices as <see cref="Render"/> writes one, limited as a whole. Sets the number of
        /// a voice to 0 that is closed and has faded. For the audio callback.</summary>
        internal static void RenderSum(
            ulong[] ids, Span<float> interleaved, int channelCount, int channel, double sampleRateHz)
        {
            fixed (ulong* voices = ids)
            fixed (float* samples = interleaved)
            {
                NativeMethods.VoicesRender(voices, (uint)ids.Length, samples,
                    (uint)(interleaved.Length / channelCount), (uint)channelCount, channel, sampleRateHz);
            }
        }

        /// <summary>Sets the gain before the limiter, 0 to 1; the change takes 10 ms while the voice sounds, delayed
        /// sound included.</summary>
        public void SetStrength(float strength) => NativeCall.Check(NativeMethods.VoiceSetStrength(Id, strength));

        /// <summary>Limits the magnitude of all output samples, 0 to 1.</summary>
        public void SetCeiling(float ceiling) => NativeCall.Check(NativeMethods.VoiceSetCeiling(Id, ceiling));

        /// <summary>Mutes the voice: it falls silent within a block and 5 ms and then costs no inference.</summary>
        public void SetMuted(bool muted) => NativeCall.Check(NativeMethods.VoiceSetMuted(Id, muted ? 1u : 0u));

        /// <summary>Mutes the voice of a suspended application, independently of <see cref="SetMuted"/>.</summary>
        public void SetPaused(bool paused) => NativeCall.Check(NativeMethods.VoiceSetPaused(Id, paused ? 1u : 0u));

        /// <summary>Silences the present touch at the end of the next block; the next touch-down sounds.</summary>
        public void Panic() => NativeCall.Check(NativeMethods.VoicePanic(Id));

        /// <summary>Panic for every voice of the process. Does nothing without the native library.</summary>
        public static void PanicAll()
        {
            try
            {
                NativeMethods.Panic();
            }
            catch (Exception error) when (NativeCall.IsMissing(error))
            {
                // Without the library no voice exists.
            }
        }

        /// <summary>Statistics since the voice was opened.</summary>
        public VoiceStatistics Statistics()
        {
            var statistics = new VoiceStatistics { StructSize = (uint)sizeof(VoiceStatistics) };
            NativeCall.Check(NativeMethods.VoiceGetStatistics(Id, &statistics));
            return statistics;
        }

        /// <summary>Delays the voice, for studies and slow displays. Lift-off ends the texture before the delay; mute,
        /// pause and panic act after it, at once.</summary>
        /// <param name="seconds">0 to 0.5; 0 for no delay. A change fades within 20 ms.</param>
        public void SetDelay(double seconds) => NativeCall.Check(NativeMethods.VoiceSetDelay(Id, seconds));

        /// <summary>Plays a sine instead of texture, impact, edge and relief, for studies of latency. It sounds while
        /// the newest contact state touches and moves at 5 mm/s or more, whatever the force and the speed; nothing is
        /// inferred. It starts and ends within 2 ms and is subject to everything that acts on the voice. Takes effect
        /// with the next block.</summary>
        /// <param name="frequencyHz">Frequency, <see cref="MinimumSignalHz"/> to <see cref="MaximumSignalHz"/>; ignored
        /// where the amplitude is 0.</param>
        /// <param name="amplitudeMps2">Peak amplitude, 0 to <see cref="MaximumSignalMps2"/>; 0 for no signal.</param>
        /// <exception cref="HaptoFlowException">The voice is closed, or a value is out of range.</exception>
        public void SetSignal(double frequencyHz, double amplitudeMps2) =>
            NativeCall.Check(NativeMethods.VoiceSetSignal(Id, frequencyHz, amplitudeMps2));

        /// <summary>Plays a clip beside the texture, with or without contact, from the next block on, in place of the
        /// one that plays. Mute, pause, panic, missing contact states and a change of the device's rate end it; while
        /// one of these silences the voice, or a signal plays, a clip is not played, nor later. Any thread except the
        /// audio callback; no garbage. The first play of a clip takes about 1 ms for each second of it.</summary>
        /// <param name="clip">May be disposed at once; null to end the present clip.</param>
        /// <param name="gain">0 to <see cref="HapticClipFile.MaximumGain"/>.</param>
        /// <param name="loop">True to repeat it until another clip, or null.</param>
        /// <returns>False where another thread is publishing at the same time: this clip is discarded.</returns>
        /// <exception cref="HaptoFlowException">The voice or the clip is closed, or the gain is out of
        /// range.</exception>
        public bool PlayClip(HapticClipFile? clip, float gain = 1f, bool loop = false)
        {
            int status = clip == null
                ? NativeMethods.VoicePlayClip(Id, IntPtr.Zero, 0f, 0u)
                : NativeMethods.VoicePlayClip(Id, clip.OpenValue, gain, loop ? 1u : 0u);
            GC.KeepAlive(clip);
            if (status == (int)HaptoFlowStatus.Busy)
            {
                return false;
            }
            NativeCall.Check(status);
            return true;
        }

        /// <summary>Number and delays of the signal's starts and stops caused by contact states.</summary>
        /// <exception cref="HaptoFlowException">The voice is closed.</exception>
        public SignalStatistics SignalStatistics()
        {
            var statistics = new SignalStatistics { StructSize = (uint)sizeof(SignalStatistics) };
            NativeCall.Check(NativeMethods.VoiceSignalStatistics(Id, &statistics));
            return statistics;
        }

        /// <summary>Sets the actuator whose resonances and weak bands are compensated.</summary>
        /// <param name="profile">An actuator profile as JSON, or the name of one in the library: "flat", "voice-coil";
        /// null for no compensation.</param>
        /// <exception cref="HaptoFlowException">The profile is not valid; the message names the key.</exception>
        public void SetActuator(string? profile)
        {
            if (profile == null)
            {
                NativeCall.Check(NativeMethods.VoiceSetActuator(Id, null, 0));
                return;
            }
            byte[] text = Encoding.UTF8.GetBytes(profile + "\0");
            fixed (byte* bytes = text)
            {
                NativeCall.Check(NativeMethods.VoiceSetActuator(Id, bytes, (ulong)(text.Length - 1)));
            }
        }

        /// <summary>Switches the exposure guard, which slowly lowers what is strong for too long, never to silence.
        /// Switched off it measures on, so that it knows the whole day when it is switched on again. Not a medical
        /// device.</summary>
        /// <param name="actuatorGain">Acceleration at the hand for each m/s^2 of the voice, above 0 to 1000.</param>
        public void SetExposureGuard(bool isOn, float actuatorGain = 1f) =>
            NativeCall.Check(NativeMethods.VoiceSetExposureGuard(Id, isOn ? 1u : 0u, actuatorGain));

        /// <summary>Makes the voice audible on loudspeakers: louder and brighter. For ears only, not for an
        /// actuator.</summary>
        public void SetListen(bool isOn) => NativeCall.Check(NativeMethods.VoiceSetListen(Id, isOn ? 1u : 0u));

        /// <summary>Measurements of the exposure guard; zeros and a gain of 1 without one that is on.</summary>
        public HapticExposure Exposure()
        {
            var exposure = new HapticExposure { StructSize = (uint)sizeof(HapticExposure) };
            NativeCall.Check(NativeMethods.VoiceExposure(Id, &exposure));
            return exposure;
        }

        /// <summary>Statistics of one stage of the voice; all zero for a stage that never ran.</summary>
        /// <exception cref="HaptoFlowException">The voice is closed, or there is no such effect.</exception>
        public EffectStatistics EffectStatistics(HapticEffect effect)
        {
            var statistics = new EffectStatistics { StructSize = (uint)sizeof(EffectStatistics) };
            NativeCall.Check(NativeMethods.VoiceEffectStatistics(Id, (int)effect, &statistics));
            return statistics;
        }

        /// <summary>Index of the voice in the process: the value for the parameter "Voice" of the mixer
        /// effect.</summary>
        public int Place()
        {
            uint place;
            NativeCall.Check(NativeMethods.VoicePlace(Id, &place));
            return (int)place;
        }

        /// <summary>Closes the voice. Waits for nothing: an output that plays it goes on until it has faded, within a
        /// block and 5 ms.</summary>
        public void Dispose()
        {
            Close();
            GC.SuppressFinalize(this);
        }

        private void Close()
        {
            ulong closing = unchecked((ulong)Interlocked.Exchange(ref voice, 0));
            if (closing != 0)
            {
                NativeMethods.VoiceDestroy(&closing);
            }
        }
    }
}
