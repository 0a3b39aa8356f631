#nullable enable
#if HAPTOFLOW_META_PARAMETRIC
using System;
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A Touch controller that plays points: OVRInput.SetControllerHapticsParametric, experimental at Meta.
    /// </summary>
    internal sealed class MetaParametricSink : IParametricSink
    {
        private const double NanosecondsPerSecond = 1e9;

        // Where the controller does not say its own.
        private const float UsualMinFrequencyHz = 50f;
        private const float UsualMaxFrequencyHz = 500f;

        private readonly MetaController controller;
        private readonly ArraysByLength<OVRInput.HapticsParametricPoint> amplitudes =
            new ArraysByLength<OVRInput.HapticsParametricPoint>();
        private readonly ArraysByLength<OVRInput.HapticsParametricPoint> frequencies =
            new ArraysByLength<OVRInput.HapticsParametricPoint>();
        private readonly ArraysByLength<OVRInput.HapticsParametricTransient> transients =
            new ArraysByLength<OVRInput.HapticsParametricTransient>();
        private int versionAsked = -1;
        private HapticSinkCapabilities asked;

        public MetaParametricSink(HapticHand hand) => controller = new MetaController(hand);

        public string Name => "a Touch controller";

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            bool holds = controller.HoldsTouch;
            if (holds && versionAsked != controller.Version)
            {
                versionAsked = controller.Version;
                Ask();
            }
            capabilities = asked;
            return holds;
        }

        public bool Submit(ReadOnlySpan<ParametricPoint> amplitudePoints, ReadOnlySpan<ParametricPoint> frequencyPoints,
            ReadOnlySpan<ParametricTransient> knocks, StreamPart part)
        {
            Send(Copy(amplitudePoints, amplitudes), Copy(frequencyPoints, frequencies), Copy(knocks), part);
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
            Send(silence, frequencies.Of(0), transients.Of(0), 0);
        }

        private void Ask()
        {
            OVRInput.HapticsParametricProperties says = OVRInput.GetControllerParametricProperties(controller.Mask);
            // Named a rate, it is an interval in nanoseconds; 0 for any.
            double rateHz = says.IdealFrameSubmissionRate > 0
                ? NanosecondsPerSecond / says.IdealFrameSubmissionRate
                : 0.0;
            bool knows = says.MaxFrequencyHz > says.MinFrequencyHz && says.MinFrequencyHz > 0f;
            asked = new HapticSinkCapabilities(rateHz, 500,
                knows ? says.MinFrequencyHz : UsualMinFrequencyHz, knows ? says.MaxFrequencyHz : UsualMaxFrequencyHz,
                says.MinimumFirstFrameDuration / NanosecondsPerSecond);
        }

        // The SDK's numbers are OpenXR's: 0 is no part of a stream.
        private void Send(OVRInput.HapticsParametricPoint[] amplitudePoints,
            OVRInput.HapticsParametricPoint[] frequencyPoints, OVRInput.HapticsParametricTransient[] knocks,
            StreamPart part) => OVRInput.SetControllerHapticsParametric(
            new OVRInput.HapticsParametricVibration
            {
                AmplitudePoints = amplitudePoints,
                FrequencyPoints = frequencyPoints,
                Transients = knocks,
                MinFrequencyHz = (float)asked.MinFrequencyHz,
                MaxFrequencyHz = (float)asked.MaxFrequencyHz,
                StreamFrameType = (OVRInput.HapticsParametricStreamFrameType)(int)part,
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

        private OVRInput.HapticsParametricTransient[] Copy(ReadOnlySpan<ParametricTransient> knocks)
        {
            OVRInput.HapticsParametricTransient[] copies = transients.Of(knocks.Length);
            for (int index = 0; index < copies.Length; ++index)
            {
                copies[index] = new OVRInput.HapticsParametricTransient
                {
                    Time = Nanoseconds(knocks[index].Seconds),
                    Amplitude = knocks[index].Amplitude,
                    Frequency = knocks[index].Frequency,
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
