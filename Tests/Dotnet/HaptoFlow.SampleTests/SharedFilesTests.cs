using System.IO;
using NUnit.Framework;

namespace HaptoFlow.SampleTests
{
    /// <summary>Samples are imported one by one, so each has its own copy of what both need.</summary>
    public sealed class SharedFilesTests : SampleTest
    {
        [TestCase("Build.cs")]
        [TestCase("StatusBoard.cs")]
        public void TheCopiesDifferInTheirNamespaceOnly(string name)
        {
            string tracing = File.ReadAllText(SampleFile("StylusTracing", name));
            Assert.That(tracing, Does.Contain("namespace HaptoFlow.Samples.StylusTracing"));
            foreach (string other in new[] { "TextureGallery", "Workshop" })
            {
                Assert.That(File.ReadAllText(SampleFile(other, name)),
                    Is.EqualTo(tracing.Replace("Samples.StylusTracing", "Samples." + other)));
            }
        }
    }
}
