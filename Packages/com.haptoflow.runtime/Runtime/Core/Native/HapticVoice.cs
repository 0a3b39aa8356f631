#nullable enable
using System;
using System.Text;
using System.Threading;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>The signal of one stylus tip. After it is closed, rendering gives silence and every other call fails.
    /// </summary>
    public sealed unsafe class HapticVoice : IDisposable
    {
        /// <summary>As a channel: all of them.</summary>
        public const int AllChannels = -1;

        private long voice;

        internal HapticVoice(ulong opened) => voice = unchecked((long)opened);

        /// <summary>Closes a voice that was forgotten.</summary>
        ~HapticVoice() => Close();

        private ulong Id => unchecked((ulong)Interlocked.Read(ref voice));

        /// <summary>What the tip does now: once a frame, also while nothing touches. Any thread but the audio
        /// callback's; no garbage.</summary>
        /// <returns>False where another thread publishes at this moment: the state is lost, the next one counts.
        /// </returns>
        /// <exception cref="HaptoFlowException">The voice is closed.</exception>
        public bool Publish(in ContactState state)
        {
            var native = new NativeContactState
            {
                StructSize = (uint)sizeof(NativeContactState),
                Touching = state.Touching ? 1u : 0u,
                TouchCounter = state.TouchCounter,
                LabelCount = (uint)state.Material.Count,
                ForceNewtons = state.ForceNewtons,
                ApproachSpeedMps = state.ApproachSpeedMps,
                Effects = (uint)state.Effects,
                EdgeCounter = state.EdgeCounter,
                EdgeHeightMetres = state.EdgeHeightMetres,
                LandingCounter = state.LandingCounter,
                SpatialScale = state.SpatialScale,
                ToneDbPerOctave = state.ToneDbPerOctave,
            };
            for (int index = 0; index < state.Material.Count; ++index)
            {
                native.Labels[index] = unchecked((uint)state.Material.Label(index));
                native.Weights[index] = state.Material.Weight(index);
            }
            native.VelocityMps[0] = state.FirstVelocityMps;
            native.VelocityMps[1] = state.SecondVelocityMps;
            int status = NativeMethods.VoicePublish(Id, &native);
            if (status == (int)HaptoFlowStatus.Busy)
            {
                return false;
            }
            NativeCall.Check(status);
            return true;
        }

        /// <summary>Writes the voice into one channel of interleaved samples, or into all; other channels stay as they
        /// are. Made for the audio callback: no garbage, no wait, no exception; microseconds.</summary>
        /// <param name="interleaved">Samples of +-1, a whole number of frames.</param>
        /// <param name="channelCount">1 to 64.</param>
        /// <param name="channel">0 to channelCount - 1, or <see cref="AllChannels"/>.</param>
        /// <returns>False where the voice was closed or busy, and wrote silence.</returns>
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

        /// <summary>Gain of the output before the limiter, 0 to 1; glides within 10 ms while the voice
        /// sounds.</summary>
        public void SetStrength(float strength) => NativeCall.Check(NativeMethods.VoiceSetStrength(Id, strength));

        /// <summary>Largest magnitude of the output, 0 to 1: whatever else happens, no sample is above it.</summary>
        public void SetCeiling(float ceiling) => NativeCall.Check(NativeMethods.VoiceSetCeiling(Id, ceiling));

        /// <summary>Muted, a voice falls silent within a block and 5 ms and costs no inference.</summary>
        public void SetMuted(bool muted) => NativeCall.Check(NativeMethods.VoiceSetMuted(Id, muted ? 1u : 0u));

        /// <summary>The same for an application that is suspended: independent of muting.</summary>
        public void SetPaused(bool paused) => NativeCall.Check(NativeMethods.VoiceSetPaused(Id, paused ? 1u : 0u));

        /// <summary>Silence at the end of the next block for what touches now; the next touch-down sounds.</summary>
        public void Panic() => NativeCall.Check(NativeMethods.VoicePanic(Id));

        /// <summary>Panic for every voice of the process. Does nothing where there is no native library.</summary>
        public static void PanicAll()
        {
            try
            {
                NativeMethods.Panic();
            }
            catch (Exception error) when (NativeCall.IsMissing(error))
            {
                // Without the library nothing sounds.
            }
        }

        /// <summary>What the voice did so far.</summary>
        public VoiceStatistics Statistics()
        {
            var statistics = new VoiceStatistics { StructSize = (uint)sizeof(VoiceStatistics) };
            NativeCall.Check(NativeMethods.VoiceGetStatistics(Id, &statistics));
            return statistics;
        }

        /// <summary>Everything comes this much later, for studies and slow displays. Lift-off closes the texture before
        /// the delay; mute, pause and panic act behind it, at once.</summary>
        /// <param name="seconds">0 to 0.5; 0 for no delay. A change fades within 20 ms.</param>
        public void SetDelay(double seconds) => NativeCall.Check(NativeMethods.VoiceSetDelay(Id, seconds));

        /// <summary>A sine for studies of latency, which sounds wherever the newest contact state touches and moves at
        /// 5 mm/s or more, whatever force and speed are, instead of texture, impact and edge; nothing is inferred. It
        /// begins and ends within 2 ms. Everything that acts on the voice acts on it. Takes effect with the next
        /// block.</summary>
        /// <param name="frequencyHz">20 to 500; ignored where the amplitude is 0.</param>
        /// <param name="amplitudeMps2">Its peak, 0 to 60 m/s^2; 0 for no signal.</param>
        /// <exception cref="HaptoFlowException">The voice is closed, or a value is out of range.</exception>
        public void SetSignal(double frequencyHz, double amplitudeMps2) =>
            NativeCall.Check(NativeMethods.VoiceSetSignal(Id, frequencyHz, amplitudeMps2));

        /// <summary>How often the signal was turned on and off by contact states, and how long that took.</summary>
        /// <exception cref="HaptoFlowException">The voice is closed.</exception>
        public SignalStatistics SignalStatistics()
        {
            var statistics = new SignalStatistics { StructSize = (uint)sizeof(SignalStatistics) };
            NativeCall.Check(NativeMethods.VoiceSignalStatistics(Id, &statistics));
            return statistics;
        }

        /// <summary>What plays the voice, so that its resonances and weak bands are evened out.</summary>
        /// <param name="profile">An actuator profile as JSON, or the name of one that the library brings along:
        /// "flat", "voice-coil"; null for no compensation.</param>
        /// <exception cref="HaptoFlowException">The profile is none; the message names the key.</exception>
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

        /// <summary>Brings down what is strong for too long, slowly and never to silence. No medical device.</summary>
        /// <param name="actuatorGain">Acceleration at the hand for each m/s^2 of the voice, above 0 to 1000.</param>
        public void SetExposureGuard(bool isOn, float actuatorGain = 1f) =>
            NativeCall.Check(NativeMethods.VoiceSetExposureGuard(Id, isOn ? 1u : 0u, actuatorGain));

        /// <summary>What the exposure guard has measured; a gain of 1 without one.</summary>
        public HapticExposure Exposure()
        {
            var exposure = new HapticExposure { StructSize = (uint)sizeof(HapticExposure) };
            NativeCall.Check(NativeMethods.VoiceExposure(Id, &exposure));
            return exposure;
        }

        /// <summary>What one stage of the voice did so far; all zero for one that nobody asked for.</summary>
        /// <exception cref="HaptoFlowException">The voice is closed, or there is no such effect.</exception>
        public EffectStatistics EffectStatistics(HapticEffect effect)
        {
            var statistics = new EffectStatistics { StructSize = (uint)sizeof(EffectStatistics) };
            NativeCall.Check(NativeMethods.VoiceEffectStatistics(Id, (int)effect, &statistics));
            return statistics;
        }

        /// <summary>The voice's place among the process's voices: what the parameter "Voice" of the mixer effect names.
        /// </summary>
        public int Place()
        {
            uint place;
            NativeCall.Check(NativeMethods.VoicePlace(Id, &place));
            return (int)place;
        }

        /// <summary>Blocks for a block that is being rendered, at most 48 ms; never for inference.</summary>
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
