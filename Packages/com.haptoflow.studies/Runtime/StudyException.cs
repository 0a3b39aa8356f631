#nullable enable
using System;

namespace HaptoFlow.Studies
{
    /// <summary>A study cannot start, continue or be logged. The message is one line for the operator: what is wrong,
    /// in which file or setting, and what to do.</summary>
    public sealed class StudyException : Exception
    {
        /// <summary>Creates an exception with a message that says what is wrong and what to do.</summary>
        public StudyException(string message)
            : base(message)
        {
        }

        /// <summary>Creates an exception with a message and the exception that caused it.</summary>
        public StudyException(string message, Exception cause)
            : base(message, cause)
        {
        }
    }
}
