#nullable enable
using System;
using System.Threading;
using HaptoFlow.Outputs;

namespace HaptoFlow.Preview
{
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
        /// <exception cref="OperationCanceledException">The token was cancelled.</exception>
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
