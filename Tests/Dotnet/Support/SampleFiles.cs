namespace HaptoFlow.Tests.Support
{
    /// <summary>Files of the packages' samples.</summary>
    internal static class SampleFiles
    {
        public static string In(string sample, string name) => sample.EndsWith("Study")
            ? RepositoryFiles.In("Packages", "com.haptoflow.studies", "Samples~", sample, name)
            : RepositoryFiles.In("Samples~", sample, name);

        /// <summary>The scene of a sample. That of Workshop is a scene of the repository's own project; packing adds it to
        /// the sample.</summary>
        public static string Scene(string sample) => sample == "Workshop"
            ? RepositoryFiles.In("Assets", "Workshop.unity")
            : In(sample, sample + ".unity");
    }
}
