using System.IO;
using NUnit.Framework;

namespace HaptoFlow.SampleTests
{
    /// <summary>Samples are imported one by one, so each has its own copy of what both need.</summary>
    public sealed class SharedFilesTests : SampleTest
    {
        [TestCase("Build.cs", "TextureGallery", "Workshop", "LatencyStudy", "SimilarityStudy")]
        [TestCase("StatusBoard.cs", "TextureGallery", "Workshop")]
        [TestCase("ButtonPress.cs", "LatencyStudy", "SimilarityStudy")]
        public void TheCopiesDifferInTheirNamespaceOnly(string name, params string[] others)
        {
            string tracing = File.ReadAllText(SampleFile("StylusTracing", name));
            Assert.That(tracing, Does.Contain("namespace HaptoFlow.Samples.StylusTracing"));
            foreach (string other in others)
            {
                Assert.That(File.ReadAllText(SampleFile(other, name)),
                    Is.EqualTo(tracing.Replace("Samples.StylusTracing", "Samples." + other)));
            }
        }
    }
}
