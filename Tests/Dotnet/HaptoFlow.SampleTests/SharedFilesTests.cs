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
            string gallery = File.ReadAllText(SampleFile("TextureGallery", name));
            Assert.That(tracing, Does.Contain("namespace HaptoFlow.Samples.StylusTracing"));
            Assert.That(gallery, Is.EqualTo(tracing.Replace("Samples.StylusTracing", "Samples.TextureGallery")));
        }
    }
}
