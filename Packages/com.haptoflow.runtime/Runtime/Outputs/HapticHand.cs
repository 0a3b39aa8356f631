#nullable enable
namespace HaptoFlow
{
    /// <summary>Which hand holds something.</summary>
    public enum HapticHand
    {
        /// <summary>Nobody said.</summary>
        None = 0,

        /// <summary>The right one.</summary>
        Right = 1,

        /// <summary>The left one.</summary>
        Left = 2,
    }
}
