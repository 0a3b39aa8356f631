#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>GameObject > HaptoFlow: what a first scene needs, each one step of undo.</summary>
    internal static class CreateMenu
    {
        private const int Place = 10;

        // Where Unity puts the camera of a new scene: too far from a cube of 30 cm.
        private static readonly Vector3 CameraOfNewScenes = new Vector3(0f, 1f, -10f);
        private static readonly Vector3 CameraPlace = new Vector3(0f, 0.4f, -0.45f);
        private static readonly Vector3 PlateSize = new Vector3(0.3f, 0.02f, 0.3f);

        /// <summary>A plate to touch, a pen under the mouse, an output: ready to play.</summary>
        [MenuItem("GameObject/HaptoFlow/First Scene", false, Place - 3)]
        internal static void CreateFirstScene(MenuCommand command)
        {
            Undo.IncrementCurrentGroup();
            Undo.SetCurrentGroupName("Create First Haptic Scene");
            int group = Undo.GetCurrentGroup();
            CreateOutput(command);
            GameObject plate = Add(TaggedCube("Wooden Plate"), null);
            plate.transform.localScale = PlateSize;
            plate.transform.position = new Vector3(0f, -0.5f * PlateSize.y, 0f);
            CreateMousePen(new MenuCommand(null));
            BringCameraNear();
            Undo.CollapseUndoOperations(group);
        }

        /// <summary>A cube of one metre made of wood.</summary>
        [MenuItem("GameObject/HaptoFlow/Tagged Cube", false, Place - 2)]
        internal static void CreateTaggedCube(MenuCommand command) => Add(TaggedCube("Tagged Cube"), command);

        /// <summary>A stylus under the mouse or a graphics pen.</summary>
        [MenuItem("GameObject/HaptoFlow/Mouse Pen", false, Place - 1)]
        internal static void CreateMousePen(MenuCommand command) => Add(MousePen.Create(null).gameObject, command);

        /// <summary>A stylus on MX Ink or a controller in the right hand.</summary>
        [MenuItem("GameObject/HaptoFlow/XR Pen (Right Hand)", false, Place - 1)]
        internal static void CreateRightPen(MenuCommand command) => CreateXrPen(command, PenHand.Right);

        /// <summary>A stylus on MX Ink or a controller in the left hand.</summary>
        [MenuItem("GameObject/HaptoFlow/XR Pen (Left Hand)", false, Place - 1)]
        internal static void CreateLeftPen(MenuCommand command) => CreateXrPen(command, PenHand.Left);

        /// <summary>Tip and component, ready to be put on whatever is tracked.</summary>
        [MenuItem("GameObject/HaptoFlow/Haptic Stylus", false, Place)]
        internal static void CreateStylus(MenuCommand command)
        {
            var owner = new GameObject("Haptic Stylus");
            var tip = new GameObject("Tip");
            tip.transform.SetParent(owner.transform, false);
            owner.AddComponent<HapticStylus>().Tip = tip.transform;
            Add(owner, command);
        }

        /// <summary>Where the wave goes; on every channel until one is chosen.</summary>
        [MenuItem("GameObject/HaptoFlow/Haptic Output", false, Place)]
        internal static void CreateOutput(MenuCommand command)
        {
            var owner = new GameObject("Haptic Output");
            owner.AddComponent<HapticOutput>();
            Add(owner, command);
        }

        /// <summary>Poses are in tracking space, which is what the camera of an XR rig lies below.</summary>
        private static void CreateXrPen(MenuCommand command, PenHand hand)
        {
            Camera? camera = Camera.main;
            Transform? space = camera != null ? camera.transform.parent : null;
            bool isChosen = command.context is GameObject;
            GameObject? parent = space != null ? space.gameObject : null;
            Add(XrPen.Create(null, hand).gameObject, isChosen ? command : new MenuCommand(parent));
        }

        private static GameObject TaggedCube(string name)
        {
            GameObject cube = GameObject.CreatePrimitive(PrimitiveType.Cube);
            cube.name = name;
            // The scene keeps a reference to it, so that players have it, too; the user may put another in its place.
            Material? ofPipeline = PipelineMaterial.OfPipeline();
            if (ofPipeline != null)
            {
                cube.GetComponent<MeshRenderer>().sharedMaterial = ofPipeline;
            }
            cube.AddComponent<HapticSurface>();
            return cube;
        }

        private static GameObject Add(GameObject made, MenuCommand? command)
        {
            GameObjectUtility.SetParentAndAlign(made, command?.context as GameObject);
            Undo.RegisterCreatedObjectUndo(made, "Create " + made.name);
            Selection.activeObject = made;
            return made;
        }

        /// <summary>A camera that somebody placed stays where it is.</summary>
        private static void BringCameraNear()
        {
            Camera? camera = Camera.main;
            if (camera != null && Vector3.Distance(camera.transform.position, CameraOfNewScenes) < 1e-3f)
            {
                Undo.RecordObject(camera.transform, "Bring Camera Near");
                camera.transform.position = CameraPlace;
                camera.transform.rotation = Quaternion.AngleAxis(40f, Vector3.right);
            }
        }
    }
}
