using System;
using System.IO;
using HaptoFlow.Tests.Support;

namespace HaptoFlow.SampleTests
{
    /// <summary>Keeps the session of a test for the tests of the training package, if an environment variable is set.
    /// </summary>
    internal static class RecordedSession
    {
        /// <summary>If HAPTOFLOW_RECORD_SESSIONS is set, replaces the sessions of the study in
        /// Tests/Golden/studies/sessions by the only session of the folder.</summary>
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
