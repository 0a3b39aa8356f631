using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;

namespace HaptoFlow.EditorTests
{
    public sealed class DeviceCheckMenuTests : EditorTest
    {
        [Test]
        public void TheMenuAddsOneCheckSelectsItAndUndoRemovesIt()
        {
            Undo.IncrementCurrentGroup();
            DeviceCheckMenu.Add();
            DeviceCheckMenu.Add();
            Assert.That(All<DeviceCheckRun>(), Has.Length.EqualTo(1));
            Assert.That(Selection.activeGameObject, Is.SameAs(All<DeviceCheckRun>().Single().gameObject));
            Undo.PerformUndo();
            Assert.That(All<DeviceCheckRun>(), Is.Empty);
        }
    }
}
