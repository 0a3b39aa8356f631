#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.DeviceCheck
{
    /// <summary>A voice that plays a simulated stroke on an audio output of its own, so that audio thread and engine
    /// are measured alike on every device. Main thread.</summary>
    internal sealed class SimulatedStroke : IDisposable
    {
        private const double StrokesPerSecond = 1.5;
        private const float FastestMps = 0.15f;
        private const float ForceNewtons = 0.5f;
        private readonly HapticOutput output = HapticOutput.Make();
        private readonly HapticVoice voice;
        private readonly double beganSeconds = Time.realtimeSinceStartupAsDouble;

        public SimulatedStroke(HapticEngine engine)
        {
            voice = engine.OpenVoice(output.SampleRateHz);
            ((IVoiceTarget)output).Add(voice);
            Record();
        }

        /// <summary>Blocks since the last call of <see cref="Record"/>.</summary>
        public BlockRecorder Blocks { get; private set; } = null!;

        /// <summary>Statistics of the voice.</summary>
        public VoiceStatistics Statistics => voice.Statistics();

        /// <summary>Begins to record blocks anew.</summary>
        public void Record()
        {
            Blocks = new BlockRecorder();
            output.Recorder = Blocks;
        }

        /// <summary>Publishes the state of this frame.</summary>
        public void Publish()
        {
            double phase = 2.0 * Math.PI * StrokesPerSecond * (Time.realtimeSinceStartupAsDouble - beganSeconds);
            voice.Publish(new ContactState
            {
                Touching = true,
                TouchCounter = 1,
                FirstVelocityMps = FastestMps * (float)Math.Cos(phase),
                ForceNewtons = ForceNewtons,
                Material = LabelBlend.Of(0),
                Effects = HapticEffects.Texture,
            });
        }

        /// <summary>Ends the stroke and removes the output.</summary>
        public void Dispose()
        {
            output.Recorder = null;
            voice.Dispose();
            if (output != null)
            {
                UnityEngine.Object.Destroy(output.gameObject);
            }
        }
    }
}
