/// <summary>Of Meta's SDK, as programs for MX Ink call it.</summary>
public static class OVRPlugin
{
    internal static float? Tip;

    public static bool GetActionStateFloat(string actionName, out float result)
    {
        result = actionName == "tip" ? Tip ?? 0f : 0f;
        return actionName == "tip" && Tip.HasValue;
    }
}
