using System;
using System.Collections.Generic;
using UnityEngine;
using UnityShim;

/// <summary>Part of Meta's SDK: the calls to the headset's runtime. They need no OVRManager. A failing call to an action
/// logs an error, as in the SDK; other failing calls return false or 0.</summary>
public static partial class OVRPlugin
{
    internal const string MxInkProfile = "/interaction_profiles/logitech/mx_ink_stylus_logitech";
    internal const string TouchProfile = "/interaction_profiles/oculus/touch_controller";
    internal const string TouchPlusProfile = "/interaction_profiles/meta/touch_controller_plus";

    private static readonly string[] Profiles = new string[2];
    private static readonly ControllerState4[] States = new ControllerState4[2];

    internal static float? Tip;
    internal static string BoundAction = "tip";
    internal static string? BoundHaptic = "haptic_pulse";
    internal static Controller Connected = Controller.None;

    [Flags]
    public enum Controller
    {
        None = 0,
        LTouch = 0x00000001,
        RTouch = 0x00000002,
        Touch = LTouch | RTouch,
        Active = unchecked((int)0x80000000),
    }

    public enum Hand
    {
        None = -1,
        HandLeft = 0,
        HandRight = 1,
    }

    public struct Vector2f
    {
        public float x;
        public float y;
    }

    public struct Vector3f
    {
        public float x;
        public float y;
        public float z;
    }

    public struct Quatf
    {
        public float x;
        public float y;
        public float z;
        public float w;
    }

    /// <summary>Right-handed: z points backwards.</summary>
    public struct Posef
    {
        public Quatf Orientation;
        public Vector3f Position;
    }

    public struct ControllerState4
    {
        public uint ConnectedControllers;
        public uint Touches;
        public Vector2f LThumbstick;
        public Vector2f RThumbstick;
    }

    public static bool hasInputFocus { get; internal set; } = true;

    /// <summary>The number of calls of <see cref="GetActionStateFloat"/>.</summary>
    internal static int Calls { get; private set; }

    /// <summary>The number of calls of <see cref="GetActionStatePose"/> that failed.</summary>
    internal static int FailedPoses { get; private set; }

    /// <summary>The number of calls of <see cref="GetCurrentInteractionProfileName"/>, each of which makes a string.
    /// </summary>
    internal static int ProfileQueries { get; private set; }

    internal static int FailedPulses { get; private set; }

    internal static List<(double Seconds, Hand Hand, float Duration, float Amplitude)> Pulses { get; } =
        new List<(double, Hand, float, float)>();

    /// <summary>The poses that actions report, by the actions' names.</summary>
    internal static Dictionary<string, Posef> Poses { get; } = new Dictionary<string, Posef>();

    public static Controller GetConnectedControllers() => Connected;

    public static string GetCurrentInteractionProfileName(Hand hand)
    {
        ++ProfileQueries;
        return Profiles[(int)hand];
    }

    public static ControllerState4 GetControllerState4(uint controllerMask) =>
        States[(controllerMask & (uint)Controller.RTouch) != 0u ? 1 : 0];

    public static bool GetActionStateFloat(string actionName, out float result)
    {
        ++Calls;
        bool runs = hasInputFocus && actionName == BoundAction && Tip.HasValue;
        result = runs ? Tip!.Value : 0f;
        if (!runs)
        {
            Debug.LogError("Error calling GetActionStateFloat: Failure_NotInitialized");
        }
        return runs;
    }

    public static bool GetActionStatePose(string actionName, out Posef result)
    {
        result = default;
        if (hasInputFocus && Poses.TryGetValue(actionName, out result))
        {
            return true;
        }
        ++FailedPoses;
        Debug.LogError("Error calling GetActionStatePose: Failure_NotInitialized");
        return false;
    }

    public static bool TriggerVibrationAction(string actionName, Hand hand, float duration, float amplitude)
    {
        bool runs = hasInputFocus && actionName == BoundHaptic && Profiles[(int)hand] == MxInkProfile;
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

    /// <summary>Puts a device into a hand.</summary>
    internal static void Take(Hand hand, string profile) => Profiles[(int)hand] = profile;

    /// <summary>Moves the right thumbstick, touched by a thumb or not.</summary>
    internal static void MoveRightStick(float x, float y, bool touched) => States[1] = new ControllerState4
    {
        RThumbstick = new Vector2f { x = x, y = y },
        Touches = touched ? (uint)OVRInput.RawTouch.RThumbstick : 0u,
    };

    internal static void Reset()
    {
        Tip = null;
        BoundAction = "tip";
        BoundHaptic = "haptic_pulse";
        Connected = Controller.None;
        hasInputFocus = true;
        Calls = 0;
        FailedPoses = 0;
        ProfileQueries = 0;
        FailedPulses = 0;
        Pulses.Clear();
        Poses.Clear();
        Take(Hand.HandLeft, TouchPlusProfile);
        Take(Hand.HandRight, TouchPlusProfile);
        Array.Clear(States, 0, States.Length);
    }

    static OVRPlugin() => Reset();
}

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
