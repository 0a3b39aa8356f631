#nullable enable
using System;
using System.Threading;
using HaptoFlow.Preview;
using HaptoFlow.Recordings;

namespace HaptoFlow.Editor
{
    /// <summary>The result of reading a recording's file in the background.</summary>
    /// <param name="Recording">Null if the file cannot be read.</param>
    /// <param name="Problem">What is wrong with the file and what was expected; null on success.</param>
    internal sealed record RecordingFile(Recording? Recording, string? Problem)
    {
        /// <summary>Reads a file; the work of a <see cref="LatestTask{TRequest,TResult}"/>.</summary>
        public static RecordingFile Read(Request request, CancellationToken token)
        {
            try
            {
                return new RecordingFile(RecordingReader.Read(request.Path, request.FullScaleMps2), null);
            }
            catch (HaptoFlowException error)
            {
                // The folder is in the window already.
                string folder = System.IO.Path.GetDirectoryName(request.Path) ?? "";
                string message = folder.Length > 0 && error.Message.StartsWith(folder, StringComparison.Ordinal)
                    ? error.Message.Substring(folder.Length + 1)
                    : error.Message;
                return new RecordingFile(null, message + ".");
            }
        }

        /// <summary>A file to read, and its full scale if it was entered.</summary>
        internal sealed record Request(string Path, double? FullScaleMps2);
    }
}
