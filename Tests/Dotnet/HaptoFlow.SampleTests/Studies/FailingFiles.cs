#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using HaptoFlow.Studies;

namespace HaptoFlow.SampleTests
{
    /// <summary>A file system whose writes can be made to fail.</summary>
    internal sealed class FailingFiles : IStudyFiles
    {
        private readonly DiskFiles disk = new DiskFiles();

        /// <summary>The error of every write; null for a disk that works.</summary>
        public Exception? Failure { get; set; }

        /// <summary>Number of bytes of a line that are written before a failure.</summary>
        public int RoomBytes { get; set; }

        /// <summary>Number of attempts to write.</summary>
        public int Attempts { get; private set; }

        public IReadOnlyList<string> Find(string folder, string pattern) => disk.Find(folder, pattern);

        public bool Exists(string path) => disk.Exists(path);

        public byte[] Read(string path) => disk.Read(path);

        public void Replace(string path, string text)
        {
            Fail();
            disk.Replace(path, text);
        }

        public void AddLine(string path, byte[] before, byte[] line)
        {
            if (Failure != null)
            {
                disk.AddLine(path, before, line.AsSpan(0, Math.Min(RoomBytes, line.Length)).ToArray());
            }
            Fail();
            disk.AddLine(path, before, line);
        }

        private void Fail()
        {
            ++Attempts;
            if (Failure != null)
            {
                throw Failure;
            }
        }
    }
}
