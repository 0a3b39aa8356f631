#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;
#if !HAPTOFLOW_OUTSIDE_UNITY
using UnityEditor.SceneManagement;
#endif

namespace HaptoFlow.EditorTests
{
    /// <summary>A test with an empty scene and a folder for assets. After each test, both are removed and the project's
    /// preloaded assets are restored.</summary>
    public abstract class EditorTest
    {
        internal const string Folder = "Assets/HaptoFlowEditorTests";

        private readonly List<Object> made = new List<Object>();
        private Object[] preloaded = Array.Empty<Object>();

        [SetUp]
        public void BeginEditing()
        {
#if HAPTOFLOW_OUTSIDE_UNITY
            UnityShim.EditorSession.Begin(Tests.Support.RepositoryFiles.In("Packages", "com.haptoflow.runtime"));
#else
            EditorSceneManager.NewScene(NewSceneSetup.EmptyScene, NewSceneMode.Single);
#endif
            preloaded = PlayerSettings.GetPreloadedAssets();
            AssetDatabase.CreateFolder("Assets", "HaptoFlowEditorTests");
            ProjectSettingsAsset.Forget();
        }

        [TearDown]
        public void EndEditing()
        {
            foreach (Object each in made)
            {
                if (each != null)
                {
                    Object.DestroyImmediate(each);
                }
            }
            made.Clear();
            AssetDatabase.DeleteAsset(Folder);
            PlayerSettings.SetPreloadedAssets(preloaded);
            ProjectSettingsAsset.Forget();
#if HAPTOFLOW_OUTSIDE_UNITY
            UnityShim.EditorSession.End();
#endif
        }

        internal static HapticModelAsset Model() => ProjectSettingsAsset.DefaultModel()!;

        /// <summary>Creates the settings of the project: a preloaded asset with the package's model.</summary>
        internal static HaptoFlowSettings Settings()
        {
            var settings = ScriptableObject.CreateInstance<HaptoFlowSettings>();
            settings.Model = Model();
            AssetDatabase.CreateAsset(settings, Folder + "/Settings.asset");
            ProjectSettingsAsset.Preload(settings);
            return settings;
        }

        /// <summary>Creates an empty material map, saved as an asset.</summary>
        internal static HapticMaterialMap CreateMap()
        {
            var map = ScriptableObject.CreateInstance<HapticMaterialMap>();
            AssetDatabase.CreateAsset(map, Folder + "/Rooms.asset");
            return map;
        }

        /// <summary>Adds a file to the project and imports it.</summary>
        internal static string Import(string name, byte[] file)
        {
            string path = Folder + "/" + name;
            File.WriteAllBytes(path, file);
            AssetDatabase.ImportAsset(path);
            return path;
        }

        internal GameObject Make(string name, GameObject? parent = null)
        {
            var gameObject = new GameObject(name);
            made.Add(gameObject);
            if (parent != null)
            {
                gameObject.transform.SetParent(parent.transform, false);
            }
            return gameObject;
        }

        /// <summary>Creates an object with a box collider.</summary>
        internal GameObject Box(string name, GameObject? parent = null)
        {
            GameObject gameObject = Make(name, parent);
            gameObject.AddComponent<BoxCollider>();
            return gameObject;
        }

        internal HapticSurface Tagged(string name, string label)
        {
            var surface = Box(name).AddComponent<HapticSurface>();
            surface.Material.Label = label;
            return surface;
        }

        /// <summary>Creates a stylus as the menu does.</summary>
        internal HapticStylus Stylus()
        {
            GameObject owner = Make("Stylus");
            GameObject tip = Make("Tip", owner);
            var stylus = owner.AddComponent<HapticStylus>();
            stylus.Tip = tip.transform;
            return stylus;
        }

        /// <summary>All objects of a kind, disabled ones too.</summary>
        internal static T[] All<T>()
            where T : Object => Object.FindObjectsByType<T>(FindObjectsInactive.Include, FindObjectsSortMode.None);

        internal static HapticMaterial Feeling(string label)
        {
            HapticMaterial material = ScriptableObject.CreateInstance<HapticMaterial>();
            material.name = label;
            material.Description.Label = label;
            return material;
        }

        internal HapticOutput Output() => Make("Output").AddComponent<HapticOutput>();
    }

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
