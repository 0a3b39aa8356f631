#nullable enable
using System.Collections.Generic;
using System.IO;
using HaptoFlow.Editor;
using HaptoFlow.Preview;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Opens a Texture Preview window with a short stroke at draft quality, and closes it after each test.
    /// </summary>
    public abstract class PreviewWindowTest
    {
        private readonly List<Object> made = new List<Object>();

        internal TexturePreviewWindow Window { get; private set; } = null!;

        internal TexturePreviewState State => Window.State;

        /// <summary>The samples of the active sound.</summary>
        internal float[] Samples => Window.Player!.PlayedSound!.Sound.Samples;

        [SetUp]
        public void OpenWindow()
        {
#if HAPTOFLOW_OUTSIDE_UNITY
            UnityShim.EditorSession.Begin(Tests.Support.RepositoryFiles.In("Packages", "com.haptoflow.runtime"));
            GUIUtility.hotControl = 0;
            EditorGUIUtility.editingTextField = false;
#endif
            ProjectSettingsAsset.Forget();
            TexturePreviewWindow.Open();
            Window = EditorWindow.GetWindow<TexturePreviewWindow>();
            State.Preset = StrokePreset.Slide;
            State.ContactSeconds = 0.3f;
            State.Tier = "draft";
            State.Compares = false;
            State.First.Label = "wood";
            State.Second.Label = "sandpaper";
            Undo.IncrementCurrentGroup();
        }

        [TearDown]
        public void CloseWindow()
        {
            if (Window != null)
            {
                Close();
            }
            foreach (Object each in made)
            {
                Object.DestroyImmediate(each);
            }
            made.Clear();
            ProjectSettingsAsset.Forget();
#if HAPTOFLOW_OUTSIDE_UNITY
            UnityShim.EditorSession.End();
#endif
        }

        internal void Close()
        {
#if HAPTOFLOW_OUTSIDE_UNITY
            UnityShim.WindowHost.Close(Window);
#else
            Window.Close();
#endif
        }

        /// <summary>A model of these bytes, destroyed after the test.</summary>
        internal HapticModelAsset Model(byte[] file)
        {
            HapticModelAsset asset = HapticModelAsset.Create(file);
            asset.name = "made";
            made.Add(asset);
            return asset;
        }

        internal GameObject Make(string name) => Keep(new GameObject(name));

        /// <summary>Creates an object with a box collider.</summary>
        internal GameObject Box(string name)
        {
            GameObject box = Make(name);
            box.AddComponent<BoxCollider>();
            return box;
        }

        internal HapticSurface Tagged(string name) => Box(name).AddComponent<HapticSurface>();

        internal HapticMaterial Feeling(string label) => Keep(HaptoFlow.EditorTests.EditorTest.Feeling(label));

        /// <summary>Destroys an object after the test.</summary>
        internal T Keep<T>(T each)
            where T : Object
        {
            made.Add(each);
            return each;
        }

        internal static byte[] DefaultFile() => ProjectSettingsAsset.DefaultModel()!.File;

        internal bool Key(KeyCode key, EventModifiers modifiers = EventModifiers.None) =>
            Window.SendEvent(new Event { type = EventType.KeyDown, keyCode = key, modifiers = modifiers });

#if HAPTOFLOW_OUTSIDE_UNITY
        internal IReadOnlyList<UnityShim.Drawn> Screen() => UnityShim.WindowHost.Draw(Window);

        internal void Press(string caption)
        {
            UnityShim.EditorScreen.Press(caption);
            Screen();
        }
#endif

        /// <summary>Path of a new file in the project's Temp folder.</summary>
        internal static string TemporaryFile()
        {
            Directory.CreateDirectory("Temp");
            return Path.Combine("Temp", Path.GetRandomFileName() + ".wav");
        }
    }
}
