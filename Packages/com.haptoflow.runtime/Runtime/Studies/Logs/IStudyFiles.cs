#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using HaptoFlow.Files;

namespace HaptoFlow.Studies
{
    /// <summary>What a study's log needs of a file system. Members throw <see cref="IOException"/> and
    /// <see cref="UnauthorizedAccessException"/>.</summary>
    internal interface IStudyFiles
    {
        /// <summary>Full paths; none where the folder is missing.</summary>
        IReadOnlyList<string> Find(string folder, string pattern);

        bool Exists(string path);

        byte[] Read(string path);

        /// <summary>Written whole or not at all, over an older file.</summary>
        void Replace(string path, string text);

        /// <summary>Adds a line. On disk when it returns; after a failure there may be a part of the line, which the
        /// next call takes away.</summary>
        /// <param name="before">What the file has to hold already.</param>
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

        /// <summary>Behind it there may be one line, whole or torn: one that could not be written to its end.</summary>
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
