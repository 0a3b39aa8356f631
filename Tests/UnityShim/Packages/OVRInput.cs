using System;
using System.Collections.Generic;
using UnityShim;

/// <summary>Part of Meta's SDK: the haptics of a controller. The list of connected controllers is filled by <see
/// cref="Update"/> only, which OVRManager calls in a scene that has one; haptics do not ask it.</summary>
public static class OVRInput
{
    internal static float SampleRateHz = 2000f;

    private static Controller connectedControllers;

    [Flags]
    public enum Controller
    {
        None = OVRPlugin.Controller.None,
        LTouch = OVRPlugin.Controller.LTouch,
        RTouch = OVRPlugin.Controller.RTouch,
        Active = OVRPlugin.Controller.Active,
    }

    [Flags]
    public enum RawTouch
    {
        None = 0,
        RThumbstick = 0x00000004,
        LThumbstick = 0x00000400,
    }

    public struct HapticsPcmVibration
    {
        public int SamplesCount;
        public float[] Samples;
        public float SampleRateHz;
        public bool Append;
    }

    public struct HapticsParametricPoint
    {
        public long Time;
        public float Value;
    }

    public struct HapticsParametricTransient
    {
        public long Time;
        public float Amplitude;
        public float Frequency;
    }

    public enum HapticsParametricStreamFrameType : uint
    {
        None = 0u,
        FirstFrame = 1u,
        IntermediateFrame = 2u,
        LastFrame = 3u,
    }

    public struct HapticsParametricVibration
    {
        public HapticsParametricPoint[] AmplitudePoints;
        public HapticsParametricPoint[] FrequencyPoints;
        public HapticsParametricTransient[] Transients;
        public float MinFrequencyHz;
        public float MaxFrequencyHz;
        public HapticsParametricStreamFrameType StreamFrameType;
    }

    public struct HapticsParametricProperties
    {
        public long IdealFrameSubmissionRate;
        public long MinimumFirstFrameDuration;
        public float MinFrequencyHz;
        public float MaxFrequencyHz;
    }

    internal static List<(double Seconds, Controller Mask, float[] Samples, float RateHz, bool Append)> Waves { get; } =
        new List<(double, Controller, float[], float, bool)>();

    internal static List<(double Seconds, HapticsParametricVibration Sent)> Parametric { get; } =
        new List<(double, HapticsParametricVibration)>();

    internal static bool Records { get; set; } = true;

    internal static int Submissions { get; private set; }

    internal static HapticsParametricProperties Properties { get; set; }

    /// <summary>The number of calls that the runtime refused.</summary>
    internal static int FailedCalls { get; private set; }

    /// <summary>The runtime refuses the next buffers, so many of them.</summary>
    internal static int BuffersToRefuse { get; set; }

    /// <summary>The number of calls of <see cref="Update"/>. A second one in a frame loses the frame's button presses
    /// for the application.</summary>
    internal static int Updates { get; private set; }

    public static void Update()
    {
        ++Updates;
        connectedControllers = (Controller)OVRPlugin.GetConnectedControllers();
    }

    public static Controller GetConnectedControllers() => connectedControllers;

    public static float GetControllerSampleRateHz(Controller controllerMask = Controller.Active)
    {
        bool runs = Answers(controllerMask) && SampleRateHz > 0f;
        FailedCalls += runs ? 0 : 1;
        return runs ? SampleRateHz : 0f;
    }

    public static int SetControllerHapticsPcm(
        HapticsPcmVibration hapticsVibration, Controller controllerMask = Controller.Active)
    {
        if (!Answers(controllerMask) || BuffersToRefuse > 0)
        {
            BuffersToRefuse = Math.Max(0, BuffersToRefuse - 1);
            ++FailedCalls;
            return 0;
        }
        ++Submissions;
        if (Records)
        {
            Waves.Add((Clock.UnscaledSeconds, controllerMask,
                hapticsVibration.Samples.AsSpan(0, hapticsVibration.SamplesCount).ToArray(),
                hapticsVibration.SampleRateHz, hapticsVibration.Append));
        }
        return Math.Min(4000, hapticsVibration.SamplesCount);
    }

    public static HapticsParametricProperties GetControllerParametricProperties(
        Controller controllerMask = Controller.Active) => Properties;

    public static void SetControllerHapticsParametric(
        HapticsParametricVibration hapticsVibration, Controller controllerMask = Controller.Active)
    {
        hapticsVibration.AmplitudePoints = (HapticsParametricPoint[])hapticsVibration.AmplitudePoints.Clone();
        hapticsVibration.FrequencyPoints = (HapticsParametricPoint[])hapticsVibration.FrequencyPoints.Clone();
        hapticsVibration.Transients = (HapticsParametricTransient[])hapticsVibration.Transients.Clone();
        Parametric.Add((Clock.UnscaledSeconds, hapticsVibration));
    }

    internal static void Reset()
    {
        connectedControllers = Controller.None;
        SampleRateHz = 2000f;
        Waves.Clear();
        Parametric.Clear();
        Records = true;
        Submissions = 0;
        FailedCalls = 0;
        BuffersToRefuse = 0;
        Updates = 0;
        Properties = default;
    }

    // The runtime knows the controllers whether or not OVRInput does.
    private static bool Answers(Controller controllerMask) => OVRPlugin.hasInputFocus &&
        ((Controller)OVRPlugin.GetConnectedControllers() & controllerMask) != 0;
}
