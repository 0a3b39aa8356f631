#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.Studies
{
    /// <summary>Spectrum of a masking noise.</summary>
    public enum NoiseColour
    {
        /// <summary>Equal power per hertz.</summary>
        White,

        /// <summary>Equal power per octave: masks a low hum at a lower loudness.</summary>
        Pink,
    }

    /// <summary>Plays noise in the headphones, so that the participant does not hear the actuator. All channels but the
    /// haptic one carry it. Add it to the Audio Listener's object.</summary>
    [AddComponentMenu("HaptoFlow/Masking Noise")]
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "masking-noise")]
    public sealed class MaskingNoise : MonoBehaviour
    {
        /// <summary>Lower limit of the level, in dB of full scale.</summary>
        public const float MinimumDecibels = -60f;

        /// <summary>Upper limit of the level, in dB of full scale: peaks of the noise stay below full scale.</summary>
        public const float MaximumDecibels = -18f;

        private const float FadeSeconds = 0.05f;

        [SerializeField, Tooltip("The output whose channel carries no noise.")]
        private HapticOutput? output;

        [SerializeField, Tooltip("The spectrum of the noise: white has equal power per hertz, pink per octave.")]
        private NoiseColour colour = NoiseColour.White;

        [SerializeField, Range(MinimumDecibels, MaximumDecibels),
         Tooltip("The root mean square of the noise, in dB of full scale.")]
        private float levelDecibels = -30f;

        private readonly NoiseGenerator generator = new NoiseGenerator();
        private volatile int hapticChannel = HapticVoice.AllChannels;
        private volatile float wantedGain;
        private volatile bool isPink;
        private volatile int sampleRateHz = 48000;
        private volatile int callCount;
        private CallWatch watch;
        private AudioFilter? filter;
        private int channelCount;
        private float gain;
        private string? loggedProblem;

        /// <summary>The output whose channel carries no noise. There is no noise without an output, or with one that
        /// plays on all channels: see <see cref="Problem"/>.</summary>
        public HapticOutput? Output { get => output; set => output = value; }

        /// <summary>Spectrum of the noise.</summary>
        public NoiseColour Colour { get => colour; set => colour = value; }

        /// <summary>Root mean square in dB of full scale, <see cref="MinimumDecibels"/> to <see
        /// cref="MaximumDecibels"/>.</summary>
        public float LevelDecibels
        {
            get => levelDecibels;
            set => levelDecibels = Mathf.Clamp(value, MinimumDecibels, MaximumDecibels);
        }

        /// <summary>Why there is no noise; null while there is. Where Unity's audio is switched off, a study cannot be
        /// run.</summary>
        public string? Problem { get; private set; }

        private void OnEnable()
        {
            ReadConfiguration(false);
            AudioSettings.OnAudioConfigurationChanged += ReadConfiguration;
        }

        private void OnDisable()
        {
            AudioSettings.OnAudioConfigurationChanged -= ReadConfiguration;
            Retire();
            gain = 0f;
        }

        private void ReadConfiguration(bool deviceWasChanged)
        {
            sampleRateHz = UnityAudio.RateHz;
            channelCount = StudyPlayer.Channels;
            watch.Restart();
            Renew();
        }

        // The engine may have dropped the filter.
        private void Renew()
        {
            Retire();
            filter = AudioFilter.AddTo(gameObject, AddNoise);
        }

        private void Retire()
        {
            if (filter != null)
            {
                filter.Retire();
            }
            filter = null;
        }

        private void Update()
        {
            UnityAudio.Poll();
            Problem = WhyNot();
            hapticChannel = Problem == null ? output!.Channel : HapticVoice.AllChannels;
            isPink = colour == NoiseColour.Pink;
            wantedGain = Problem == null ? (float)Math.Pow(10.0, 0.05 * levelDecibels) : 0f;
            if (Problem != null && !string.Equals(Problem, loggedProblem, StringComparison.Ordinal))
            {
                Debug.LogError($"HaptoFlow: {Problem}", this);
            }
            loggedProblem = Problem;
            if (watch.Misses((ulong)callCount, Problem == null && !AudioListener.pause))
            {
                Debug.LogWarning($"HaptoFlow: the masking noise of {name} is silent: for a second, Unity's audio has not " +
                    "asked it for samples. It tries once more now; if that does not help, put it on the object of the " +
                    "Audio Listener that is in use.", this);
                Renew();
            }
        }

        private string? WhyNot()
        {
            if (UnityAudio.Problem != null)
            {
                return "there is neither masking noise nor anything to feel: " + UnityAudio.Problem;
            }
            if (output == null)
            {
                return "there is no masking noise: choose the output whose channel carries no noise in the field " +
                    "Output";
            }
            if (output.Channel < 0)
            {
                return "there is no masking noise: the haptic output plays on all channels, and one has to be left " +
                    "to the headphones; choose its channel";
            }
            return output.Channel >= channelCount || channelCount < 2
                ? $"there is no masking noise: the audio device has {channelCount} channels and the haptic output " +
                    $"plays on channel {output.Channel}, counted from 0; choose an audio device with a channel for each"
                : null;
        }

        // Audio thread: no garbage, no locks.
        private void AddNoise(float[] data, int channels)
        {
            callCount = unchecked(callCount + 1);
            int excluded = hapticChannel;
            if (excluded < 0)
            {
                gain = 0f;
                return;
            }
            float step = 1f / (FadeSeconds * sampleRateHz);
            float wanted = wantedGain;
            for (int first = 0; first + channels <= data.Length; first += channels)
            {
                gain += Math.Max(-step, Math.Min(step, wanted - gain));
                float sample = gain * generator.Next(isPink);
                for (int channel = 0; channel < channels; ++channel)
                {
                    if (channel != excluded)
                    {
                        ref float place = ref data[first + channel];
                        place = Math.Max(-1f, Math.Min(1f, place + sample));
                    }
                }
            }
        }
    }

    /// <summary>Noise with a root mean square of 1. System.Random is slower and allocates its state table. One thread
    /// at a time; no garbage.</summary>
    internal sealed class NoiseGenerator
    {
        // Uniform numbers of +-1 have a root mean square of 1 / sqrt(3).
        private const float WhiteScale = 1.7320508f;

        // Normalises the filter's output for white noise with a root mean square of 1, from its impulse response.
        private static readonly float PinkScale;

        private readonly float[] state = new float[7];
        private uint bits = 0x9E3779B9u;

        // An explicit static constructor runs when the first generator is created, not on the audio thread.
        static NoiseGenerator() => PinkScale = FindPinkScale();

        public float Next(bool isPink)
        {
            // Marsaglia (2003), Xorshift RNGs.
            bits ^= bits << 13;
            bits ^= bits >> 17;
            bits ^= bits << 5;
            float white = WhiteScale * (bits * (2f / 4294967296f) - 1f);
            return isPink ? PinkScale * Filtered(state, white) : white;
        }

        /// <summary>Paul Kellet's filter (1999): within 0.1 dB of -3 dB per octave above 9 Hz at 44.1 kHz.</summary>
        private static float Filtered(float[] state, float white)
        {
            state[0] = 0.99886f * state[0] + white * 0.0555179f;
            state[1] = 0.99332f * state[1] + white * 0.0750759f;
            state[2] = 0.96900f * state[2] + white * 0.1538520f;
            state[3] = 0.86650f * state[3] + white * 0.3104856f;
            state[4] = 0.55000f * state[4] + white * 0.5329522f;
            state[5] = -0.7616f * state[5] - white * 0.0168980f;
            float pink = state[0] + state[1] + state[2] + state[3] + state[4] + state[5] + state[6] + white * 0.5362f;
            state[6] = white * 0.115926f;
            return pink;
        }

        private static float FindPinkScale()
        {
            var quiet = new float[7];
            double energy = 0.0;
            for (int sample = 0; sample < 20000; ++sample)
            {
                double response = Filtered(quiet, sample == 0 ? 1f : 0f);
                energy += response * response;
            }
            return (float)(1.0 / Math.Sqrt(energy));
        }
    }
}
