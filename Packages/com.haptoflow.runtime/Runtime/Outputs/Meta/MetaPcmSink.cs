#nullable enable
using System;
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A Touch controller that plays waveforms: OVRInput.SetControllerHapticsPcm.</summary>
    internal sealed class MetaPcmSink : IWaveformSink
    {
        private const int MaximumSamples = 4000;

        private readonly MetaController controller;
        private readonly float[] samples = new float[MaximumSamples];
        private int queriedVersion = -1;
        private float rateHz;

        public MetaPcmSink(HapticHand hand) => controller = new MetaController(hand);

        public string Name => "a Touch controller";

        // Without Append a submission starts at once and replaces what plays.
        public bool ReplacesWithoutGap => true;

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            bool holds = controller.HoldsTouch;
            if (holds && queriedVersion != controller.Version)
            {
                queriedVersion = controller.Version;
                rateHz = OVRInput.GetControllerSampleRateHz(controller.Mask);
                if (!(rateHz > 0f))
                {
                    controller.Fail();
                }
            }
            capabilities = new HapticSinkCapabilities(rateHz, MaximumSamples);
            return holds && rateHz > 0f;
        }

        public int Submit(ReadOnlySpan<float> wave, bool replace)
        {
            int count = Math.Min(wave.Length, samples.Length);
            wave.Slice(0, count).CopyTo(samples);
            int taken = OVRInput.SetControllerHapticsPcm(
                new OVRInput.HapticsPcmVibration
                {
                    SamplesCount = count,
                    Samples = samples,
                    SampleRateHz = rateHz,
                    Append = !replace,
                },
                controller.Mask);
            if (taken > 0 || !replace)
            {
                return taken;
            }
            controller.Fail();
            return -1;
        }

        public void Stop()
        {
            if (controller.HoldsTouch)
            {
                samples[0] = 0f;
                Submit(samples.AsSpan(0, 1), true);
            }
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Register() => HapticSinks.Register(
            "Meta PCM", HapticForm.Waveform, 20, hand => new MetaPcmSink(hand));
    }
}
