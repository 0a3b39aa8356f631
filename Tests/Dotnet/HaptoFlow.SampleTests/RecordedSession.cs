using System;
using System.IO;
using HaptoFlow.Tests.Support;

namespace HaptoFlow.SampleTests
{
    /// <summary>The session of a test, kept for the training package's tests where the environment asks for it.</summary>
    internal static class RecordedSession
    {
        /// <summary>With HAPTOFLOW_RECORD_SESSIONS set, the folder's only session takes the place of those of its study
        /// in Tests/Golden/studies/sessions.</summary>
        public static void Keep(string folder, string study)
        {
            if (string.IsNullOrEmpty(Environment.GetEnvironmentVariable("HAPTOFLOW_RECORD_SESSIONS")))
            {
                return;
            }
            string sessions = RepositoryFiles.In("Tests", "Golden", "studies", "sessions");
            foreach (string old in Directory.GetFiles(sessions, study + "-*"))
            {
                File.Delete(old);
            }
            foreach (string file in Directory.GetFiles(folder))
            {
                File.Copy(file, Path.Combine(sessions, Path.GetFileName(file)));
            }
        }
    }
}
