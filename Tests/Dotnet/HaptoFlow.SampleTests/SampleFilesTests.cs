using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.SampleTests
{
    /// <summary>The code that several samples need is part of the package, outside of any of them.</summary>
    public sealed class SampleFilesTests
    {
        [Test]
        public void NoScriptHasTheSameNameInTwoSamples()
        {
            string[] folders =
            {
                RepositoryFiles.In("Samples~"),
                RepositoryFiles.In("Packages", "com.haptoflow.runtime", "Runtime", "SampleScenes"),
            };
            string[] scripts = folders.SelectMany(
                folder => Directory.GetFiles(folder, "*.cs", SearchOption.AllDirectories)).ToArray();
            IEnumerable<string> shared = scripts.GroupBy(Path.GetFileName).Where(each => each.Count() > 1)
                .Select(each => each.Key!);
            Assert.That(scripts, Has.Length.GreaterThan(20));
            Assert.That(shared, Is.Empty);
        }
    }
}
