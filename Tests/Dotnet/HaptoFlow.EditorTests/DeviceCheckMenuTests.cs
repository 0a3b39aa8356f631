using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

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
            Assert.That(All(), Has.Length.EqualTo(1));
            Assert.That(Selection.activeGameObject, Is.SameAs(All().Single().gameObject));
            Undo.PerformUndo();
            Assert.That(All(), Is.Empty);
        }

        private static DeviceCheckRun[] All() => Object.FindObjectsByType<DeviceCheckRun>(
            FindObjectsInactive.Include, FindObjectsSortMode.None);
    }
}
