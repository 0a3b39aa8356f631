using System;
using System.Collections.Generic;
using UnityEngine;
using UnityShim;

public static partial class OVRPlugin
{
    internal const string MxInkProfile = "/interaction_profiles/logitech/mx_ink_stylus_logitech";
    internal const string TouchPlusProfile = "/interaction_profiles/meta/touch_controller_plus";

    internal static string Profile = TouchPlusProfile;
    internal static string? BoundHaptic = "haptic_pulse";

    public enum Hand
    {
        None = -1,
        HandLeft = 0,
        HandRight = 1,
    }

    internal static List<(double Seconds, Hand Hand, float Duration, float Amplitude)> Pulses { get; } =
        new List<(double, Hand, float, float)>();

    internal static int FailedPulses { get; private set; }

    public static string GetCurrentInteractionProfile(Hand hand) => Profile;

    /// <summary>Each failing call logs an error, as in the SDK.</summary>
    public static bool TriggerVibrationAction(string actionName, Hand hand, float duration, float amplitude)
    {
        bool runs = hasInputFocus && actionName == BoundHaptic && Profile == MxInkProfile;
        if (runs)
        {
            Pulses.Add((Clock.UnscaledSeconds, hand, duration, amplitude));
        }
        else
        {
            ++FailedPulses;
            Debug.LogError("Error calling TriggerVibrationAction: Failure_ActionNotFound");
        }
        return runs;
    }

    private static void ResetHaptics()
    {
        Profile = TouchPlusProfile;
        BoundHaptic = "haptic_pulse";
        Pulses.Clear();
        FailedPulses = 0;
    }
}

/// <summary>Part of Meta's SDK: the haptics of a controller.</summary>
public static class OVRInput
{
    internal static Controller Connected = Controller.None;
    internal static float SampleRateHz = 2000f;

    [Flags]
    public enum Controller
    {
        None = 0,
        LTouch = 0x00000001,
        RTouch = 0x00000002,
        Active = unchecked((int)0x80000000),
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

    public enum HapticsParametricStreamFrameType
    {
        None = 0,
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

    /// <summary>The number of calls for which the SDK logs an error.</summary>
    internal static int FailedCalls { get; private set; }

    public static Controller GetConnectedControllers() => Connected;

    public static float GetControllerSampleRateHz(Controller controllerMask = Controller.Active)
    {
        bool runs = (Connected & controllerMask) != 0 && OVRPlugin.hasInputFocus && SampleRateHz > 0f;
        FailedCalls += runs ? 0 : 1;
        return runs ? SampleRateHz : 0f;
    }

    public static int SetControllerHapticsPcm(
        HapticsPcmVibration hapticsVibration, Controller controllerMask = Controller.Active)
    {
        if ((Connected & controllerMask) == 0 || !OVRPlugin.hasInputFocus)
        {
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
        Connected = Controller.None;
        SampleRateHz = 2000f;
        Waves.Clear();
        Parametric.Clear();
        Records = true;
        Submissions = 0;
        FailedCalls = 0;
        Properties = default;
    }
}
