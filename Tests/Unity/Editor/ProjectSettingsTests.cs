#nullable enable
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.EditorTests
{
    public sealed class ProjectSettingsTests : EditorTest
    {
        [SetUp]
        public void RemovePreloadedSettings()
        {
            PlayerSettings.SetPreloadedAssets(new Object[0]);
            ProjectSettingsAsset.Forget();
            Assume.That(ProjectSettingsAsset.Find(), Is.Null, "this project has settings of its own");
        }

        [TearDown]
        public void DeleteCreatedSettings() => AssetDatabase.DeleteAsset(ProjectSettingsAsset.Path);

        [Test]
        public void FindingSettingsCreatesNone()
        {
            Assert.That(ProjectSettingsAsset.Find(), Is.Null);
            Assert.That(AssetDatabase.FindAssets("t:HaptoFlowSettings"), Is.Empty);
        }

        [Test]
        public void SettingsAreCreatedOnlyOnce()
        {
            HaptoFlowSettings first = ProjectSettingsAsset.FindOrCreate();
            HaptoFlowSettings second = ProjectSettingsAsset.FindOrCreate();
            Assert.That(second, Is.SameAs(first));
            Assert.That(first.Model, Is.EqualTo(Model()));
            Assert.That(AssetDatabase.FindAssets("t:HaptoFlowSettings"), Has.Length.EqualTo(1));
            Assert.That(AssetDatabase.GetAssetPath(first), Is.EqualTo(ProjectSettingsAsset.Path));
            Assert.That(PlayerSettings.GetPreloadedAssets(), Is.EqualTo(new Object[] { first }));
        }

        [Test]
        public void OtherPreloadedAssetsAreKept()
        {
            HapticMaterial other = ScriptableObject.CreateInstance<HapticMaterial>();
            AssetDatabase.CreateAsset(other, Folder + "/Other.asset");
            PlayerSettings.SetPreloadedAssets(new Object[] { other });
            HaptoFlowSettings settings = ProjectSettingsAsset.FindOrCreate();
            Assert.That(PlayerSettings.GetPreloadedAssets(), Is.EqualTo(new Object[] { other, settings }));
        }

        [Test]
        public void ExistingSettingsOfTheProjectAreUsed()
        {
            var lying = ScriptableObject.CreateInstance<HaptoFlowSettings>();
            AssetDatabase.CreateAsset(lying, Folder + "/Mine.asset");
            ProjectSettingsAsset.Forget();
            Assert.That(ProjectSettingsAsset.Find(), Is.EqualTo(lying));
            Assert.That(ProjectSettingsAsset.IsPreloaded(lying), Is.False);
            Assert.That(ProjectSettingsAsset.FindOrCreate(), Is.EqualTo(lying));
            Assert.That(ProjectSettingsAsset.IsPreloaded(lying), Is.True);
            Assert.That(AssetDatabase.FindAssets("t:HaptoFlowSettings"), Has.Length.EqualTo(1));
        }

        [Test]
        public void SettingsInAResourcesFolderReachPlayersWithoutPreloading()
        {
            AssetDatabase.CreateAsset(ScriptableObject.CreateInstance<HaptoFlowSettings>(), Folder + "/First.asset");
            AssetDatabase.CreateFolder(Folder, "Resources");
            var found = ScriptableObject.CreateInstance<HaptoFlowSettings>();
            AssetDatabase.CreateAsset(found, Folder + "/Resources/HaptoFlowSettings.asset");
            ProjectSettingsAsset.Forget();
            Assert.That(ProjectSettingsAsset.FindOrCreate(), Is.EqualTo(found));
            Assert.That(ProjectSettingsAsset.ReachesPlayers(found), Is.True);
            Assert.That(PlayerSettings.GetPreloadedAssets(), Is.Empty);
        }

        [Test]
        public void PreloadedSettingsTakePrecedence()
        {
            foreach (string name in new[] { "First", "Second" })
            {
                AssetDatabase.CreateAsset(
                    ScriptableObject.CreateInstance<HaptoFlowSettings>(), $"{Folder}/{name}.asset");
            }
            var second = AssetDatabase.LoadAssetAtPath<HaptoFlowSettings>(Folder + "/Second.asset");
            ProjectSettingsAsset.Preload(second);
            Assert.That(ProjectSettingsAsset.Find(), Is.EqualTo(second));
            var first = AssetDatabase.LoadAssetAtPath<HaptoFlowSettings>(Folder + "/First.asset");
            ProjectSettingsAsset.Preload(first);
            Assert.That(ProjectSettingsAsset.Find(), Is.EqualTo(first));
            Assert.That(PlayerSettings.GetPreloadedAssets().OfType<HaptoFlowSettings>(), Is.EqualTo(new[] { first }),
                "one at a time");
        }
    }
}
