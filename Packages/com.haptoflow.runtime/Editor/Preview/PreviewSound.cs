#nullable enable
using System;
using System.Threading;
using HaptoFlow.Outputs;

namespace HaptoFlow.Preview
{
    /// <summary>The vibration of a stroke on a material, as samples. Immutable by convention; any thread.</summary>
    internal sealed class PreviewSound
    {
        public const int RateHz = 48000;

        /// <summary>Full scale: acceleration of a sample of 1, in m/s^2.</summary>
        public const float FullScaleMps2 = (float)HapticEngineOptions.DefaultFullScaleMps2;

        /// <param name="samples">In units of <see cref="FullScaleMps2"/>, -1 to 1.</param>
        public PreviewSound(
            LabelMix material, Stroke stroke, float[] samples, PreviewDevice device = PreviewDevice.Actuator)
        {
            Title = device == PreviewDevice.Actuator ? material.Title : DeviceRendering.NameOf(device);
            Material = material;
            Stroke = stroke;
            Samples = samples;
            double squares = 0.0;
            long touched = 0;
            for (int index = 0; index < samples.Length; ++index)
            {
                float size = Math.Abs(samples[index]);
                Peak = Math.Max(Peak, size);
                if (stroke.At(index / (double)RateHz).Touching)
                {
                    squares += size * size;
                    ++touched;
                }
            }
            RmsMps2 = FullScaleMps2 * Math.Sqrt(squares / Math.Max(1, touched));
        }

        public string Title { get; }
        public LabelMix Material { get; }
        public Stroke Stroke { get; }

        /// <summary>One channel in units of <see cref="FullScaleMps2"/>, -1 to 1.</summary>
        public float[] Samples { get; }

        public double DurationSeconds => Samples.Length / (double)RateHz;

        /// <summary>Largest magnitude, 0 to 1.</summary>
        public float Peak { get; }

        public double PeakMps2 => FullScaleMps2 * Peak;

        public double RmsMps2 { get; }
    }

    /// <summary>Renders a stroke with a voice, not in real time.</summary>
    internal static class StrokeRenderer
    {
        /// <summary>Renders each contact state in the order of the native offline renderer: publish the state, render
        /// its first sample, run inference, render the samples up to the next state. Never the main thread.</summary>
        /// <param name="engine">Without worker. If no voice was opened in it before and its lead is fixed, the samples
        /// depend only on stroke and seed.</param>
        /// <param name="surface">Material, effects, feature scale, tone of the surface; its motion is ignored.</param>
        /// <param name="relief">The relief of the surface, which says where each state lies in its map; null for
        /// none.</param>
        /// <returns>Samples at <see cref="PreviewSound.RateHz"/>, as long as the stroke.</returns>
        public static float[] Render(
            HapticEngine engine, Stroke stroke, in ContactState surface, PreviewRelief? relief,
            CancellationToken token)
        {
            using HapticVoice voice = engine.OpenVoice(PreviewSound.RateHz);
            var samples = new float[Frames(stroke.DurationSeconds)];
            for (int index = 0; index < stroke.States.Count; ++index)
            {
                token.ThrowIfCancellationRequested();
                int begin = Frames(index / Stroke.UpdateRateHz);
                int end = Frames((index + 1) / Stroke.UpdateRateHz);
                Span<float> block = samples.AsSpan(begin, end - begin);
                StrokeState state = stroke.States[index];
                ContactState contact = state.ContactOn(surface);
                contact.ReliefPlace = relief?.PlaceOf(state) ?? default;
                voice.Publish(contact);
                voice.Render(block.Slice(0, 1), 1, 0, PreviewSound.RateHz);
                engine.Step();
                voice.Render(block.Slice(1), 1, 0, PreviewSound.RateHz);
            }
            ThrowIfFailed(voice.Statistics());
            return samples;
        }

        private static int Frames(double seconds) => (int)Math.Round(seconds * PreviewSound.RateHz);

        private static void ThrowIfFailed(in VoiceStatistics statistics)
        {
            if (statistics.Failures > 0)
            {
                throw new HaptoFlowException(HaptoFlowStatus.InferenceFailed,
                    $"the network failed {statistics.Failures} times in this stroke: import the model again");
            }
        }
    }

    internal enum PreviewDevice
    {
        Actuator = 0,

        Controller = 1,

        /// <summary>A motor that vibrates at one frequency with a variable amplitude.</summary>
        Motor = 2,
    }

    /// <summary>Simulates devices that play frames of amplitude and frequency in place of the waveform. Any thread but
    /// the audio thread.</summary>
    internal static class DeviceRendering
    {
        private const double ControllerFrameSeconds = 0.005;
        private const double MotorFrameSeconds = 0.008;
        private const double MinimumHz = 60.0;
        private const double MaximumHz = 400.0;
        private const double MotorHz = 160.0;

        // Time constant with which a motor's amplitude follows its input.
        private const double MotorRiseSeconds = 0.015;
        private const int BlockFrames = PreviewSound.RateHz / 100;

        /// <summary>A title for the device's sound, for example "as a motor of 160 Hz plays it".</summary>
        public static string NameOf(PreviewDevice device) => device switch
        {
            PreviewDevice.Controller => "as a controller plays its frames",
            PreviewDevice.Motor => $"as a motor of {MotorHz:0} Hz plays it",
            _ => "the waveform",
        };

        /// <summary>What the device plays for a sound.</summary>
        /// <exception cref="HaptoFlowException">The library is missing.</exception>
        public static PreviewSound Render(PreviewSound source, PreviewDevice device, CancellationToken token)
        {
            bool isMotor = device == PreviewDevice.Motor;
            double frameSeconds = isMotor ? MotorFrameSeconds : ControllerFrameSeconds;
            using var features = new WaveFeatures(frameSeconds, BlockFrames, PreviewSound.RateHz)
            {
                FullScaleMps2 = PreviewSound.FullScaleMps2,
            };
            features.SetRange(isMotor ? MotorHz : MinimumHz, isMotor ? MotorHz : MaximumHz);
            var carrier = new Carrier(frameSeconds * PreviewSound.RateHz, isMotor ? MotorRiseSeconds : 0.0);
            var frames = new WaveFrame[features.MaximumFrames];
            var played = new float[source.Samples.Length];
            for (int begin = 0; begin < played.Length; begin += BlockFrames)
            {
                token.ThrowIfCancellationRequested();
                int count = Math.Min(BlockFrames, played.Length - begin);
                int completed = features.Process(source.Samples.AsSpan(begin, count), frames);
                for (int index = 0; index < completed; ++index)
                {
                    carrier.Play(frames[index], played);
                }
            }
            return new PreviewSound(source.Material, source.Stroke, played, device);
        }

        /// <summary>A sinusoid of continuous phase whose amplitude and frequency are interpolated linearly between
        /// frames.</summary>
        private sealed class Carrier
        {
            private readonly double frameSamples;
            private readonly double follow;
            private double end;
            private double phase;
            private double amplitude;
            private double frequencyHz;
            private double played;
            private int at;

            public Carrier(double frameSamples, double riseSeconds)
            {
                this.frameSamples = frameSamples;
                follow = riseSeconds > 0.0 ? 1.0 - Math.Exp(-1.0 / (riseSeconds * PreviewSound.RateHz)) : 1.0;
            }

            public void Play(in WaveFrame frame, float[] into)
            {
                end += frameSamples;
                int last = Math.Min(into.Length, (int)Math.Round(end));
                int count = last - at;
                double fromAmplitude = amplitude;
                double fromHz = frequencyHz > 0.0 ? frequencyHz : frame.FrequencyHz;
                for (int index = 0; at < last; ++at, ++index)
                {
                    double share = (index + 1.0) / count;
                    amplitude = fromAmplitude + share * (frame.Amplitude - fromAmplitude);
                    frequencyHz = fromHz + share * (frame.FrequencyHz - fromHz);
                    played += follow * (amplitude - played);
                    phase = (phase + frequencyHz / PreviewSound.RateHz) % 1.0;
                    into[at] = (float)Math.Max(-1.0, Math.Min(1.0, played * Math.Sin(2.0 * Math.PI * phase)));
                }
            }
        }
    }
}
