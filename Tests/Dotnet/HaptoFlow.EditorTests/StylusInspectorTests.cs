using System.Linq;
using HaptoFlow.EditorTests;
using NUnit.Framework;
using UnityEditor;
using UnityShim;

namespace HaptoFlow.EditorShimTests
{
    public sealed class StylusInspectorTests : EditorTest
    {
        [Test]
        public void ForceThresholdsAreShownOnlyForMeasuredForce()
        {
            HapticStylus stylus = Stylus();
            Assert.That(Fields(stylus), Has.No.Member("Press Force (N)"));
            EditorScreen.Enter("Touch By", TouchDecision.MeasuredForce);
            Fields(stylus);
            Assert.That(stylus.TouchBy, Is.EqualTo(TouchDecision.MeasuredForce));
            Assert.That(Fields(stylus), Has.Member("Press Force (N)"));
            EditorScreen.Enter("Press Force (N)", 0.25f);
            Fields(stylus);
            Assert.That(stylus.ForceDecision.PressNewtons, Is.EqualTo(0.25f));
            Assert.That(EditorScreen.Draw(UnityEditor.Editor.CreateEditor(new UnityEngine.Object[] { stylus }).OnInspectorGUI)
                .Select(item => item.Label), Has.Some.Contains("geometry decides"));
        }

        private static string[] Fields(HapticStylus stylus) => EditorScreen
            .Draw(UnityEditor.Editor.CreateEditor(new UnityEngine.Object[] { stylus }).OnInspectorGUI)
            .Where(item => item.Kind == DrawnKind.Field).Select(item => item.Label).ToArray();
    }
}
