#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;

namespace HaptoFlow.EditorTests
{
    /// <summary>A scene and a project in which the check finds nothing; tests plant a fault, and it finds that one and
    /// no other. What it says of this machine's audio device is left out.</summary>
    public abstract class SceneCheckTest : EditorTest
    {
        internal HaptoFlowSettings ProjectSettings { get; private set; } = null!;

        internal HapticStylus ScenesStylus { get; private set; } = null!;

        internal HapticOutput ScenesOutput { get; private set; } = null!;

        [SetUp]
        public void MakeACleanScene()
        {
            ProjectSettings = Settings();
            ScenesStylus = Stylus();
            ScenesOutput = Output();
            Tagged("Table", "wood");
        }

        internal static IReadOnlyList<Finding> Findings() =>
            SceneCheck.Run().Where(finding => !finding.Text.Contains("audio device")).ToArray();

        internal static IEnumerable<string> Texts() => Findings().Select(finding => finding.Text);

        /// <summary>The one finding.</summary>
        internal static Finding Only(string part)
        {
            IReadOnlyList<Finding> findings = Findings();
            Assert.That(findings.Select(finding => finding.Text), Has.Exactly(1).Items.And.All.Contains(part));
            return findings[0];
        }

        /// <summary>Does what the button does; then the finding is gone.</summary>
        internal static void Repair(Finding finding, string caption)
        {
            finding.Repairs.Single(repair => repair.Caption == caption).Act();
            Assert.That(Texts(), Is.Empty);
        }
    }
}
