using System;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.ProjectCheck;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>The console of a clone without ONNX Runtime.</summary>
    public sealed class RuntimeIsInstalledTests : SceneTest
    {
        [Test]
        public void AfterNpmCiTheConsoleIsSilent()
        {
            RuntimeIsInstalled.Check(RepositoryFiles.Root);
            Assert.That(Errors(), Is.Empty);
        }

        [Test]
        public void WithoutItTheConsoleNamesTheCommandAndTheFolder()
        {
            string clone = Path.Combine(Path.GetTempPath(), $"haptoflow-clone-{Guid.NewGuid():N}");
            LogAssert.Expect(LogType.Error, new Regex("\"npm ci\" in "));
            RuntimeIsInstalled.Check(clone);
            Assert.That(Errors().Single(), Does.Contain(clone).And.Contain("open the project again"));
        }

        private static string[] Errors() =>
            Log.Lines.Where(line => line.Type == LogType.Error).Select(line => line.Text).ToArray();
    }
}
