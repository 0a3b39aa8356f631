#nullable enable
namespace HaptoFlow
{
    /// <summary>The hand that holds a device or a stylus.</summary>
    public enum HapticHand
    {
        /// <summary>No hand was set.</summary>
        None = 0,

        /// <summary>The right hand.</summary>
        Right = 1,

        /// <summary>The left hand.</summary>
        Left = 2,
    }

    /// <summary>Words for hands.</summary>
    internal static class HapticHands
    {
        /// <summary>"left" or "right", for sentences; the hand is not None.</summary>
        public static string InWords(this HapticHand hand) => hand == HapticHand.Left ? "left" : "right";
    }
}
