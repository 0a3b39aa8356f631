#nullable enable
using System;

namespace HaptoFlow
{
    /// <summary>A call into the native library failed, or a model file is not usable. The message says what was wrong
    /// and what to do.</summary>
    public sealed class HaptoFlowException : Exception
    {
        /// <summary>With what was wrong and what to do.</summary>
        public HaptoFlowException(HaptoFlowStatus status, string message)
            : base(message) => Status = status;

        /// <summary>With what was wrong, what to do, and what it came from.</summary>
        public HaptoFlowException(HaptoFlowStatus status, string message, Exception cause)
            : base(message, cause) => Status = status;

        /// <summary>Why the call failed.</summary>
        public HaptoFlowStatus Status { get; }
    }
}
