using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.Recordings;

namespace HaptoFlow.Tests.Support
{
    /// <summary>Recordings for tests.</summary>
    internal static class MadeRecordings
    {
        /// <summary>The recording from which the sample Workshop learns, and the files beside it.</summary>
        public static string DoormatFolder => RepositoryFiles.In(
            "Packages", "com.haptoflow.runtime", "Runtime", "SampleScenes");

        public static Recording Doormat() => RecordingReader.Read("doormat.wav", Directory
            .GetFiles(DoormatFolder, "doormat*")
            .ToDictionary(path => Path.GetFileName(path).Replace(".bytes", ""), File.ReadAllBytes));

        /// <summary>A table without files beside it.</summary>
        public static Recording Table(string text) => RecordingReader.Read("made.csv",
            new Dictionary<string, byte[]> { ["made.csv"] = System.Text.Encoding.UTF8.GetBytes(text) });
    }
}
