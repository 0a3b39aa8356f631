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
}
