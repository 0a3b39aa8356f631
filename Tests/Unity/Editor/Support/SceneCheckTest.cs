#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;

namespace HaptoFlow.EditorTests
{
    /// <summary>A test with a scene and a project without findings. Tests add a fault, and the scene check has to find
    /// only that one. Findings about the audio device of the machine are left out.</summary>
    public abstract class SceneCheckTest : EditorTest
    {
        internal HaptoFlowSettings ProjectSettings { get; private set; } = null!;

        internal HapticStylus ScenesStylus { get; private set; } = null!;

        internal HapticOutput ScenesOutput { get; private set; } = null!;

        [SetUp]
        public void CreateACleanScene()
        {
            ProjectSettings = Settings();
            ScenesStylus = Stylus();
            ScenesOutput = Output();
            Tagged("Table", "wood");
        }

        internal static IReadOnlyList<Finding> Findings() =>
            SceneCheck.Run().Where(finding => !finding.Text.Contains("audio device")).ToArray();

        internal static IEnumerable<string> Texts() => Findings().Select(finding => finding.Text);

        /// <summary>The only finding that contains a text.</summary>
        internal static Finding Only(string part)
        {
            IReadOnlyList<Finding> findings = Findings();
            Assert.That(findings.Select(finding => finding.Text), Has.Exactly(1).Items.And.All.Contains(part));
            return findings[0];
        }

        /// <summary>Presses the button of a repair, and checks that the finding has gone.</summary>
        internal static void Repair(Finding finding, string caption)
        {
            finding.Repairs.Single(repair => repair.Caption == caption).Act();
            Assert.That(Texts(), Is.Empty);
        }
    }
}
