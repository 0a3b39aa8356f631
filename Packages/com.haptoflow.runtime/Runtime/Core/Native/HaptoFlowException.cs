#nullable enable
using System;

namespace HaptoFlow
{
    /// <summary>A call into the native library failed, or a model file is not usable. The message says what is wrong
    /// and what to do.</summary>
    public sealed class HaptoFlowException : Exception
    {
        /// <summary>Creates an exception with a message that says what is wrong and what to do.</summary>
        public HaptoFlowException(HaptoFlowStatus status, string message)
            : base(message) => Status = status;

        /// <summary>Creates an exception with a message and the exception that caused it.</summary>
        public HaptoFlowException(HaptoFlowStatus status, string message, Exception cause)
            : base(message, cause) => Status = status;

        /// <summary>Why the call failed.</summary>
        public HaptoFlowStatus Status { get; }
    }
}
