#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>The menu GameObject > HaptoFlow: creates objects, each as one step of undo.</summary>
    internal static class CreateMenu
    {
        private const int Priority = 10;
        private const string PlateName = "Wooden Plate";

        // The camera position in a new scene, which is too far from a plate of 30 cm.
        private static readonly Vector3 DefaultCameraPosition = new Vector3(0f, 1f, -10f);
        private static readonly Vector3 NearCameraPosition = new Vector3(0f, 0.4f, -0.45f);
        // A low table, within the reach of somebody who sits or stands.
        private static readonly Vector3 PlateInFrontOfRig = new Vector3(0f, 0.75f, 0.4f);
        private static readonly Vector3 PlateSize = new Vector3(0.3f, 0.02f, 0.3f);

        /// <summary>Creates a plate, pens and an output: a scene that is ready to play. The pen is under the mouse; in
        /// the rig of a headset there is one in each hand instead, and the plate is within their reach. What the scene
        /// has already is not created again.</summary>
        [MenuItem("GameObject/HaptoFlow/First Scene", false, Priority - 3)]
        internal static void CreateFirstScene(MenuCommand command)
        {
            Undo.IncrementCurrentGroup();
            Undo.SetCurrentGroupName("Create First Haptic Scene");
            int group = Undo.GetCurrentGroup();
            if (All<HapticOutput>().Length == 0)
            {
                AddOutput(command).Processing.Listen = true;
            }
            Transform? rig = HeadsetRig.Find();
            HapticSurface? before = All<HapticSurface>().FirstOrDefault(surface => surface.name == PlateName);
            GameObject plate = before != null ? before.gameObject : CreatePlate(rig);
            if (rig != null)
            {
                CreateRightPen(new MenuCommand(null));
                CreateLeftPen(new MenuCommand(null));
            }
            else if (All<MousePen>().Length == 0)
            {
                CreateMousePen(new MenuCommand(null));
                BringCameraNear();
            }
            Selection.activeObject = plate;
            Undo.CollapseUndoOperations(group);
        }

        [MenuItem("GameObject/HaptoFlow/Tagged Cube", false, Priority - 2)]
        internal static void CreateTaggedCube(MenuCommand command) => Add(TaggedCube("Tagged Cube"), command);

        [MenuItem("GameObject/HaptoFlow/Mouse Pen", false, Priority - 1)]
        internal static void CreateMousePen(MenuCommand command) => Add(MousePen.Create(null).gameObject, command);

        [MenuItem("GameObject/HaptoFlow/XR Pen (Right Hand)", false, Priority - 1)]
        internal static void CreateRightPen(MenuCommand command) => CreateXrPen(command, PenHand.Right);

        [MenuItem("GameObject/HaptoFlow/XR Pen (Left Hand)", false, Priority - 1)]
        internal static void CreateLeftPen(MenuCommand command) => CreateXrPen(command, PenHand.Left);

        /// <summary>Creates a stylus with a tip, to be put below a tracked object.</summary>
        [MenuItem("GameObject/HaptoFlow/Haptic Stylus", false, Priority)]
        internal static void CreateStylus(MenuCommand command)
        {
            var owner = new GameObject("Haptic Stylus");
            var tip = new GameObject("Tip");
            tip.transform.SetParent(owner.transform, false);
            owner.AddComponent<HapticStylus>().Tip = tip.transform;
            Add(owner, command);
        }

        /// <summary>Creates an output. It plays on every channel until one is chosen.</summary>
        [MenuItem("GameObject/HaptoFlow/Haptic Output", false, Priority)]
        internal static void CreateOutput(MenuCommand command) => AddOutput(command);

        private static HapticOutput AddOutput(MenuCommand command)
        {
            var output = new GameObject("Haptic Output").AddComponent<HapticOutput>();
            Add(output.gameObject, command);
            return output;
        }

        /// <summary>Creates the pen below the parent of the main camera, the tracking space of an XR rig.</summary>
        private static void CreateXrPen(MenuCommand command, PenHand hand)
        {
            Camera? camera = Camera.main;
            Transform? space = camera != null ? camera.transform.parent : null;
            bool isChosen = command.context is GameObject;
            GameObject? parent = isChosen ? (GameObject)command.context! : space != null ? space.gameObject : null;
            // Two pens in one hand would interrupt each other's vibration.
            XrPen? before = All<XrPen>().FirstOrDefault(pen =>
                pen.Hand == hand && pen.transform.parent == (parent != null ? parent.transform : null));
            if (before != null)
            {
                Selection.activeObject = before.gameObject;
                Debug.Log($"HaptoFlow: {before.name} was selected, because this hand has a pen already.", before);
                return;
            }
            Add(XrPen.Create(null, hand).gameObject, new MenuCommand(parent));
        }

        private static GameObject CreatePlate(Transform? rig)
        {
            GameObject plate = Add(TaggedCube(PlateName), null);
            Vector3 top = rig != null ? rig.position + rig.rotation * PlateInFrontOfRig : Vector3.zero;
            plate.transform.localScale = PlateSize;
            plate.transform.rotation = rig != null ? rig.rotation : Quaternion.identity;
            plate.transform.position = top - 0.5f * PlateSize.y * Vector3.up;
            return plate;
        }

        private static T[] All<T>()
            where T : Object => Object.FindObjectsByType<T>(FindObjectsInactive.Include, FindObjectsSortMode.None);

        private static GameObject TaggedCube(string name)
        {
            GameObject cube = GameObject.CreatePrimitive(PrimitiveType.Cube);
            cube.name = name;
            // Assigned here and not by a Pipeline Material, so that the scene refers to it and the user can replace it.
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

        /// <summary>Moves the main camera near to the plate, unless the user has moved it.</summary>
        private static void BringCameraNear()
        {
            Camera? camera = Camera.main;
            if (camera != null && Vector3.Distance(camera.transform.position, DefaultCameraPosition) < 1e-3f)
            {
                Undo.RecordObject(camera.transform, "Bring Camera Near");
                camera.transform.position = NearCameraPosition;
                camera.transform.rotation = Quaternion.AngleAxis(40f, Vector3.right);
            }
        }
    }

    /// <summary>Finds the rig of a headset in the open scenes. The packages that bring rigs are optional, so their
    /// components are recognised by name.</summary>
    internal static class HeadsetRig
    {
        private static readonly string[] RigNames = { "XROrigin", "XRRig", "OVRCameraRig", nameof(XrRig) };

        /// <summary>The object of the rig above the main camera: it lies on the floor, below the player. Null without a
        /// rig.</summary>
        public static Transform? Find()
        {
            Camera? camera = Camera.main;
            var components = new List<Component>();
            for (Transform? place = camera != null ? camera.transform : null; place != null; place = place.parent)
            {
                place.GetComponents(components);
                // A component whose script is missing is null.
                if (components.Exists(each => each != null && Array.IndexOf(RigNames, each.GetType().Name) >= 0))
                {
                    return place;
                }
            }
            return null;
        }
    }
}
