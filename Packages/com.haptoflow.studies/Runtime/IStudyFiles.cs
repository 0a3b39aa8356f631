#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using HaptoFlow.Files;

namespace HaptoFlow.Studies
{
    /// <summary>The file system as a study's log uses it. Members throw <see cref="IOException"/> and <see
    /// cref="UnauthorizedAccessException"/>.</summary>
    internal interface IStudyFiles
    {
        /// <summary>Full paths of matching files; none where the folder is missing.</summary>
        IReadOnlyList<string> Find(string folder, string pattern);

        bool Exists(string path);

        byte[] Read(string path);

        /// <summary>Writes a file atomically, replacing an older one.</summary>
        void Replace(string path, string text);

        /// <summary>Appends a line; it is on disk when the call returns. A failure may leave part of the line, which
        /// the next call removes.</summary>
        /// <param name="before">The expected present contents of the file.</param>
        void AddLine(string path, byte[] before, byte[] line);
    }

    internal sealed class DiskFiles : IStudyFiles
    {
        public IReadOnlyList<string> Find(string folder, string pattern) =>
            Directory.Exists(folder) ? Directory.GetFiles(folder, pattern) : Array.Empty<string>();

        public bool Exists(string path) => File.Exists(path);

        public byte[] Read(string path) => File.ReadAllBytes(path);

        public void Replace(string path, string text) => WholeFile.Write(path, text);

        public void AddLine(string path, byte[] before, byte[] line)
        {
            using var stream = new FileStream(path, FileMode.Open, FileAccess.ReadWrite, FileShare.Read);
            if (!HoldsOnly(stream, before))
            {
                throw new IOException("another program changed the file while the study ran; put it back as it was");
            }
            stream.SetLength(before.Length);
            stream.Seek(0, SeekOrigin.End);
            stream.Write(line, 0, line.Length);
            stream.Flush(true);
        }

        /// <summary>True where the file holds the expected contents, followed at most by one complete or incomplete
        /// line.</summary>
        private static bool HoldsOnly(FileStream stream, byte[] before)
        {
            var content = new byte[stream.Length];
            int filled = 0;
            int read;
            while (filled < content.Length && (read = stream.Read(content, filled, content.Length - filled)) > 0)
            {
                filled += read;
            }
            if (filled < before.Length || !content.AsSpan(0, before.Length).SequenceEqual(before))
            {
                return false;
            }
            int lineEnd = Array.IndexOf(content, (byte)'\n', before.Length);
            return lineEnd < 0 || lineEnd == content.Length - 1;
        }
    }
}
