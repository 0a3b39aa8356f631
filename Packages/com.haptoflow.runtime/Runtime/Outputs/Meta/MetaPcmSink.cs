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

        public MetaPcmSink(HapticHand hand) => controller = new MetaController(hand, 0.05);

        public string Name => "a Touch controller";

        // Without Append a submission starts at once and replaces what plays.
        public bool ReplacesWithoutGap => true;

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            bool holds = controller.HoldsTouch;
            if (holds && (queriedVersion != controller.Version || !(rateHz > 0f)))
            {
                queriedVersion = controller.Version;
                QueryRate();
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
            if (taken > 0)
            {
                controller.Succeed();
                return taken;
            }
            if (!replace)
            {
                return 0;
            }
            if (controller.Fail())
            {
                Debug.LogWarning($"HaptoFlow: the Touch controller in the {controller.Name} hand refused a waveform. " +
                    "HaptoFlow tries again, less and less often, and meanwhile uses the next route to it.");
            }
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

        // The runtime may answer 0 Hz until it knows the controller.
        private void QueryRate()
        {
            rateHz = OVRInput.GetControllerSampleRateHz(controller.Mask);
            if (!(rateHz > 0f) && controller.Fail())
            {
                Debug.Log($"HaptoFlow: the Touch controller in the {controller.Name} hand reports 0 Hz as its rate for " +
                    "waveforms. HaptoFlow asks again, less and less often, and meanwhile uses the next route to it.");
            }
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Register() => HapticSinks.Register(
            "Meta PCM", HapticForm.Waveform, 20, hand => new MetaPcmSink(hand));
    }
}
