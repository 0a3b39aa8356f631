#nullable enable
using System;

namespace HaptoFlow.Studies
{
    /// <summary>A study cannot begin, go on or be written down. The message is one line for the operator: what is
    /// wrong, in which file or setting, and what to do.</summary>
    public sealed class StudyException : Exception
    {
        /// <summary>With what is wrong and what to do.</summary>
        public StudyException(string message)
            : base(message)
        {
        }

        /// <summary>With what is wrong, what to do, and what it came from.</summary>
        public StudyException(string message, Exception cause)
            : base(message, cause)
        {
        }
    }
}
