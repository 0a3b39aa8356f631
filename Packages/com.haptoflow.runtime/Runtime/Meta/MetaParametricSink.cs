#nullable enable
#if HAPTOFLOW_META_PARAMETRIC
using System;
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A Touch controller that plays parametric points: OVRInput.SetControllerHapticsParametric, experimental
    /// at Meta.</summary>
    internal sealed class MetaParametricSink : IParametricSink
    {
        private const double NanosecondsPerSecond = 1e9;

        // Used where the controller does not report its own limits.
        private const float DefaultMinFrequencyHz = 50f;
        private const float DefaultMaxFrequencyHz = 500f;

        private readonly MetaController controller;
        private readonly ArraysByLength<OVRInput.HapticsParametricPoint> amplitudes =
            new ArraysByLength<OVRInput.HapticsParametricPoint>();
        private readonly ArraysByLength<OVRInput.HapticsParametricPoint> frequencies =
            new ArraysByLength<OVRInput.HapticsParametricPoint>();
        private readonly ArraysByLength<OVRInput.HapticsParametricTransient> transients =
            new ArraysByLength<OVRInput.HapticsParametricTransient>();
        private int queriedVersion = -1;
        private HapticSinkCapabilities capabilitiesOfController;

        public MetaParametricSink(HapticHand hand) => controller = new MetaController(hand, 0.05);

        public string Name => "a Touch controller";

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            bool holds = controller.HoldsTouch;
            if (holds && queriedVersion != controller.Version)
            {
                queriedVersion = controller.Version;
                QueryCapabilities();
            }
            capabilities = capabilitiesOfController;
            return holds;
        }

        public bool Submit(ReadOnlySpan<ParametricPoint> amplitudePoints, ReadOnlySpan<ParametricPoint> frequencyPoints,
            ReadOnlySpan<ParametricTransient> transientPoints, StreamPart part)
        {
            // The SDK numbers the parts of a stream as OpenXR does.
            Send(Copy(amplitudePoints, amplitudes), Copy(frequencyPoints, frequencies), Copy(transientPoints),
                (OVRInput.HapticsParametricStreamFrameType)(uint)part);
            return true;
        }

        public void Stop()
        {
            if (!controller.HoldsTouch)
            {
                return;
            }
            OVRInput.HapticsParametricPoint[] silence = amplitudes.Of(2);
            silence[0] = new OVRInput.HapticsParametricPoint { Time = 0L, Value = 0f };
            silence[1] = new OVRInput.HapticsParametricPoint { Time = 1000000L, Value = 0f };
            Send(silence, frequencies.Of(0), transients.Of(0), OVRInput.HapticsParametricStreamFrameType.None);
        }

        private void QueryCapabilities()
        {
            OVRInput.HapticsParametricProperties reported = OVRInput.GetControllerParametricProperties(controller.Mask);
            // The field is named a rate but holds an interval in nanoseconds; 0 for any.
            double rateHz = reported.IdealFrameSubmissionRate > 0
                ? NanosecondsPerSecond / reported.IdealFrameSubmissionRate
                : 0.0;
            bool hasLimits = reported.MaxFrequencyHz > reported.MinFrequencyHz && reported.MinFrequencyHz > 0f;
            capabilitiesOfController = new HapticSinkCapabilities(rateHz, 500,
                hasLimits ? reported.MinFrequencyHz : DefaultMinFrequencyHz,
                hasLimits ? reported.MaxFrequencyHz : DefaultMaxFrequencyHz,
                reported.MinimumFirstFrameDuration / NanosecondsPerSecond);
        }

        private void Send(OVRInput.HapticsParametricPoint[] amplitudePoints,
            OVRInput.HapticsParametricPoint[] frequencyPoints, OVRInput.HapticsParametricTransient[] transientPoints,
            OVRInput.HapticsParametricStreamFrameType part) => OVRInput.SetControllerHapticsParametric(
            new OVRInput.HapticsParametricVibration
            {
                AmplitudePoints = amplitudePoints,
                FrequencyPoints = frequencyPoints,
                Transients = transientPoints,
                MinFrequencyHz = (float)capabilitiesOfController.MinFrequencyHz,
                MaxFrequencyHz = (float)capabilitiesOfController.MaxFrequencyHz,
                StreamFrameType = part,
            },
            controller.Mask);

        private static OVRInput.HapticsParametricPoint[] Copy(
            ReadOnlySpan<ParametricPoint> points, ArraysByLength<OVRInput.HapticsParametricPoint> arrays)
        {
            OVRInput.HapticsParametricPoint[] copies = arrays.Of(points.Length);
            for (int index = 0; index < copies.Length; ++index)
            {
                copies[index] = new OVRInput.HapticsParametricPoint
                {
                    Time = Nanoseconds(points[index].Seconds),
                    Value = points[index].Value,
                };
            }
            return copies;
        }

        private OVRInput.HapticsParametricTransient[] Copy(ReadOnlySpan<ParametricTransient> transientPoints)
        {
            OVRInput.HapticsParametricTransient[] copies = transients.Of(transientPoints.Length);
            for (int index = 0; index < copies.Length; ++index)
            {
                copies[index] = new OVRInput.HapticsParametricTransient
                {
                    Time = Nanoseconds(transientPoints[index].Seconds),
                    Amplitude = transientPoints[index].Amplitude,
                    Frequency = transientPoints[index].Frequency,
                };
            }
            return copies;
        }

        private static long Nanoseconds(double seconds) => (long)Math.Round(seconds * NanosecondsPerSecond);

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Register() => HapticSinks.Register(
            "Meta parametric", HapticForm.Parametric, 20, hand => new MetaParametricSink(hand));
    }
}
#endif
