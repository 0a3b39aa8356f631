#nullable enable
using System;

namespace HaptoFlow
{
    /// <summary>Why a call into the native library failed.</summary>
    public enum HaptoFlowStatus
    {
        /// <summary>The call succeeded.</summary>
        Ok = 0,

        /// <summary>A null pointer, a handle that is not open, an index or number out of range, or an unknown
        /// name.</summary>
        InvalidArgument = 1,

        /// <summary>Memory is exhausted.</summary>
        OutOfMemory = 2,

        /// <summary>An error in the library itself.</summary>
        InternalError = 3,

        /// <summary>Another thread is publishing to, or rendering, this voice.</summary>
        Busy = 4,

        /// <summary>The model file cannot be opened or read.</summary>
        ModelUnreadable = 10,

        /// <summary>The bytes are not a .haptoflow file.</summary>
        NotAModel = 11,

        /// <summary>The model file ends too early: get it again.</summary>
        ModelTruncated = 12,

        /// <summary>The file's format is newer than this library: update HaptoFlow.</summary>
        ModelTooNew = 13,

        /// <summary>A length or count exceeds the format's limits.</summary>
        ModelOversized = 14,

        /// <summary>A checksum does not match: the file was changed or damaged in transfer.</summary>
        ModelDamaged = 15,

        /// <summary>The file is intact but breaks a rule of its format, or one of its graphs does.</summary>
        ModelInconsistent = 16,

        /// <summary>The material was learnt for another model: learn it again with this one.</summary>
        MaterialMismatch = 17,

        /// <summary>The text is not a material file; the message names the key.</summary>
        MaterialInvalid = 18,

        /// <summary>Nothing can be learnt from the recording; the message says why.</summary>
        RecordingUnusable = 19,

        /// <summary>There is no ONNX Runtime of version 1.16 or newer at the given place.</summary>
        RuntimeUnavailable = 20,

        /// <summary>A graph failed while running, or returned numbers that are not finite.</summary>
        InferenceFailed = 21,

        /// <summary>A load ended because its <see cref="HapticCancellation"/> was cancelled.</summary>
        Cancelled = 22,

        /// <summary>A probe run of a tier took too long; the message names the tier.</summary>
        TierTooSlow = 23,

        /// <summary>The native library audioplugin_haptoflow, or a function of it, is missing.</summary>
        LibraryUnavailable = 100,

        /// <summary>The native library belongs to another version of the package than its C# scripts.</summary>
        LibraryMismatch = 101,
    }

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
