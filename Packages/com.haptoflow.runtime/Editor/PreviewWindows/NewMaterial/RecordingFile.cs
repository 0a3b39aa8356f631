#nullable enable
using System.Threading;
using HaptoFlow.Preview;
using HaptoFlow.Recordings;

namespace HaptoFlow.Editor
{
    /// <summary>A recording's file, read in the background.</summary>
    internal sealed class RecordingFile
    {
        private RecordingFile(Request request, Recording? recording, string? problem)
        {
            Asked = request;
            Recording = recording;
            Problem = problem;
        }

        public Request Asked { get; }

        /// <summary>Null where it cannot be read.</summary>
        public Recording? Recording { get; }

        /// <summary>What was wrong with the file and what was expected; null where nothing was.</summary>
        public string? Problem { get; }

        /// <summary>For <see cref="LatestTask{TRequest,TResult}"/>.</summary>
        public static RecordingFile Read(Request request, CancellationToken token)
        {
            try
            {
                return new RecordingFile(request, RecordingReader.Read(request.Path, request.FullScaleMps2), null);
            }
            catch (HaptoFlowException error)
            {
                return new RecordingFile(request, null, error.Message + ".");
            }
        }

        /// <summary>Which file, and what nobody wrote beside it.</summary>
        internal sealed class Request
        {
            public Request(string path, double? fullScaleMps2)
            {
                Path = path;
                FullScaleMps2 = fullScaleMps2;
            }

            public string Path { get; }

            public double? FullScaleMps2 { get; }
        }
    }
}
