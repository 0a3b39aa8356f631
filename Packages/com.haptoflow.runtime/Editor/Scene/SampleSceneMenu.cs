#nullable enable
using HaptoFlow.SampleScenes;
using UnityEditor;
using UnityEditor.SceneManagement;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.SceneManagement;

namespace HaptoFlow.Editor
{
    /// <summary>Makes the scenes of samples, ready to play: Window > HaptoFlow > Sample Scenes. A package from a clone or
    /// a git URL has their scripts, but no sample to import.</summary>
    internal static class SampleSceneMenu
    {
        private const string Recording =
            "Packages/com.haptoflow.runtime/Runtime/SampleScenes/doormat.";

        // From above the near edge of a table, and in front of a wall.
        private static readonly Vector3 AboveTable = new Vector3(0f, 0.5f, -0.5f);
        private static readonly Vector3 BeforeWall = new Vector3(0f, -0.11f, -0.85f);
        private static readonly Vector3 LightPosition = new Vector3(0f, 2f, 0f);
        private static readonly Color LightColour = new Color(1f, 0.96f, 0.9f);
        private static readonly Color Ambient = new Color(0.5f, 0.52f, 0.56f);
        private static readonly Color Background = new Color(0.12f, 0.13f, 0.15f, 0f);

        [MenuItem("Window/HaptoFlow/Sample Scenes/Stylus Tracing", false, 2104)]
        internal static void MakeStylusTracing() => Make<TracingScene>("Tracing Scene", AboveTable, 45f);

        [MenuItem("Window/HaptoFlow/Sample Scenes/Texture Gallery", false, 2105)]
        internal static void MakeTextureGallery() => Make<GalleryScene>("Gallery Scene", BeforeWall, 0f);

        /// <summary>A bench whose materials are assigned by rules, with a panel that learns one.</summary>
        [MenuItem("Window/HaptoFlow/Sample Scenes/Workshop", false, 2106)]
        internal static void MakeWorkshop()
        {
            WorkshopScene? scene = Make<WorkshopScene>("Workshop Scene", AboveTable, 45f);
            if (scene != null)
            {
                scene.gameObject.AddComponent<AddMaterialPanel>().SetRecording(
                    Load("wav.bytes"), Load("json"), Load("motion.csv"));
            }
        }

        [MenuItem("Window/HaptoFlow/Sample Scenes/Device Check", false, 2107)]
        internal static void MakeDeviceCheck() => Make<DeviceCheckScene>("Device Check", AboveTable, 45f);

        /// <summary>Whether a scene can be made: not while one is played.</summary>
        [MenuItem("Window/HaptoFlow/Sample Scenes/Stylus Tracing", true)]
        [MenuItem("Window/HaptoFlow/Sample Scenes/Texture Gallery", true)]
        [MenuItem("Window/HaptoFlow/Sample Scenes/Workshop", true)]
        [MenuItem("Window/HaptoFlow/Sample Scenes/Device Check", true)]
        internal static bool CanMake() => !EditorApplication.isPlayingOrWillChangePlaymode;

        /// <summary>Opens a new scene with a camera, a light and a component that builds the rest.</summary>
        /// <returns>The component; null where the user does not want to leave the open scene.</returns>
        private static TScene? Make<TScene>(string name, Vector3 cameraPosition, float downDegrees)
            where TScene : BuiltScene
        {
            if (!EditorSceneManager.SaveCurrentModifiedScenesIfUserWantsTo())
            {
                return null;
            }
            Scene made = EditorSceneManager.NewScene(NewSceneSetup.EmptyScene, NewSceneMode.Single);
            RenderSettings.ambientMode = AmbientMode.Flat;
            RenderSettings.ambientLight = Ambient;
            Camera camera = AddCamera(cameraPosition, downDegrees);
            AddLight();
            TScene scene = new GameObject(name).AddComponent<TScene>();
            scene.Model = ProjectSettingsAsset.DefaultModel();
            scene.View = camera;
            EditorSceneManager.MarkSceneDirty(made);
            Selection.activeGameObject = scene.gameObject;
            return scene;
        }

        private static Camera AddCamera(Vector3 position, float downDegrees)
        {
            var owner = new GameObject("Main Camera") { tag = "MainCamera" };
            owner.transform.SetPositionAndRotation(position, Quaternion.AngleAxis(downDegrees, Vector3.right));
            var camera = owner.AddComponent<Camera>();
            camera.clearFlags = CameraClearFlags.SolidColor;
            camera.backgroundColor = Background;
            camera.nearClipPlane = 0.01f;
            camera.farClipPlane = 50f;
            camera.depth = -1f;
            owner.AddComponent<AudioListener>();
            return camera;
        }

        private static void AddLight()
        {
            var owner = new GameObject("Directional Light");
            owner.transform.SetPositionAndRotation(LightPosition,
                Quaternion.AngleAxis(-30f, Vector3.up) * Quaternion.AngleAxis(50f, Vector3.right));
            var light = owner.AddComponent<Light>();
            light.type = LightType.Directional;
            light.color = LightColour;
            light.shadows = LightShadows.Soft;
        }

        private static TextAsset Load(string ending) => AssetDatabase.LoadAssetAtPath<TextAsset>(Recording + ending);
    }

    /// <summary>Adds the device check to the open scene, also in play mode: Window > HaptoFlow > Device Check.</summary>
    internal static class DeviceCheckMenu
    {
        [MenuItem("Window/HaptoFlow/Device Check", false, 2103)]
        internal static void Add()
        {
            DeviceCheckRun[] present = Object.FindObjectsByType<DeviceCheckRun>(
                FindObjectsInactive.Include, FindObjectsSortMode.None);
            GameObject owner = present.Length > 0 ? present[0].gameObject : new GameObject("Device Check");
            if (present.Length == 0)
            {
                owner.AddComponent<DeviceCheckRun>();
                if (!Application.isPlaying)
                {
                    Undo.RegisterCreatedObjectUndo(owner, "Create Device Check");
                }
            }
            Selection.activeGameObject = owner;
            Debug.Log("HaptoFlow: the object Device Check " + (Application.isPlaying
                ? "runs in this scene now: follow the words in the game view."
                : "runs when you press Play: follow the words in the game view. Delete it afterwards."), owner);
        }
    }

    /// <summary>Opens the documentation's first page: Window > HaptoFlow > Documentation.</summary>
    internal static class DocumentationMenu
    {
        [MenuItem("Window/HaptoFlow/Documentation", false, 2110)]
        internal static void Open()
        {
            string address = HelpPages.AddressOfPage(HelpPages.Index);
            if (address.Length == 0)
            {
                Debug.LogWarning("HaptoFlow: this package came without its pages, as it does from a git URL. They are in " +
                    "the tarball of a release, and in the folder Documentation~ of a clone.");
                return;
            }
            Application.OpenURL(address);
        }
    }
}
