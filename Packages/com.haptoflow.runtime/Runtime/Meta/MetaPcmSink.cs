#nullable enable
using System;
using HaptoFlow.Outputs;
using UnityEngine;
using UnityEngine.Scripting;

// No scene needs to reference this assembly, which registers pens and device routes when it is loaded.
[assembly: AlwaysLinkAssembly]

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

    /// <summary>The device in one hand as a route of Meta's SDK sees it. No call is made while the session has no input
    /// focus or the hand is empty. After a failure the next call waits, longer each time, unless the session or the
    /// controllers change; each failure is logged once until then.</summary>
    internal sealed class MetaController
    {
        private readonly MetaHand hand;
        private readonly RetryDelay retry;
        private int version = -1;

        /// <param name="firstRetrySeconds">Delay after a failure, doubled with each further one. Calls of which the SDK
        /// logs each failure need a long one.</param>
        public MetaController(HapticHand hand, double firstRetrySeconds)
        {
            this.hand = new MetaHand(hand);
            retry = new RetryDelay(firstRetrySeconds, 32.0 * firstRetrySeconds);
            Name = hand.InWords();
        }

        public OVRInput.Controller Mask => (OVRInput.Controller)hand.Mask;

        public OVRPlugin.Hand Hand => hand.Hand;

        public string Name { get; }

        /// <summary>Increases whenever cached capabilities may be out of date.</summary>
        public int Version => hand.Version;

        /// <summary>True while a Touch controller is in the hand and a call may be made.</summary>
        public bool HoldsTouch => IsUsable() && hand.IsConnected && !hand.HoldsMxInk && !hand.HoldsDisguisedMxInk;

        /// <summary>True while an MX Ink with its action set is in the hand and a call may be made.</summary>
        public bool HoldsMxInk => IsUsable() && hand.HoldsMxInk;

        /// <summary>Call it after a failed call.</summary>
        /// <returns>True where it should be logged.</returns>
        public bool Fail() => retry.Fail(Time.realtimeSinceStartupAsDouble);

        public void Succeed() => retry.Forget();

        private bool IsUsable()
        {
            hand.Refresh();
            if (hand.Version != version)
            {
                version = hand.Version;
                retry.Restart();
            }
            return hand.HasFocus && retry.IsDue(Time.realtimeSinceStartupAsDouble);
        }
    }
}
