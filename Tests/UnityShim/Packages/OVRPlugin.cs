using UnityEngine;

/// <summary>Part of Meta's SDK: the functions that programs for MX Ink call.</summary>
public static partial class OVRPlugin
{
    internal static float? Tip;
    internal static string BoundAction = "tip";
    internal static Controller Connected = Controller.RTouch;

    internal static int Calls { get; private set; }

    public enum Controller
    {
        None = 0,
        LTouch = 0x00000001,
        RTouch = 0x00000002,
    }

    public static bool hasInputFocus { get; internal set; } = true;

    public static Controller GetConnectedControllers() => Connected;

    /// <summary>Each failing call logs an error, as in the SDK.</summary>
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

    internal static void Reset()
    {
        Tip = null;
        BoundAction = "tip";
        Connected = Controller.RTouch;
        hasInputFocus = true;
        Calls = 0;
        ResetHaptics();
    }
}
