using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.SampleTests
{
    /// <summary>Samples are imported one by one, so the code that several of them need is part of the package.
    /// </summary>
    public sealed class SampleFilesTests
    {
        [Test]
        public void NoScriptHasTheSameNameInTwoSamples()
        {
            string[] scripts = Directory.GetFiles(RepositoryFiles.In("Samples~"), "*.cs", SearchOption.AllDirectories);
            IEnumerable<string> shared = scripts.GroupBy(Path.GetFileName).Where(each => each.Count() > 1)
                .Select(each => each.Key!);
            Assert.That(scripts, Has.Length.GreaterThan(20));
            Assert.That(shared, Is.Empty);
        }
    }
}
