using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using UnityEngine;
using UnityEngine.InputSystem;
using UnityEngine.InputSystem.Controls;
using UnityEngine.InputSystem.Layouts;
using UnityEngine.InputSystem.XR;
using UnityEngine.XR;
using UnityEngine.XR.OpenXR;
using UnityEngine.XR.OpenXR.Features;
using UnityEngine.XR.OpenXR.Input;
using ActionConfig = UnityEngine.XR.OpenXR.Features.OpenXRInteractionFeature.ActionConfig;
using ActionMapConfig = UnityEngine.XR.OpenXR.Features.OpenXRInteractionFeature.ActionMapConfig;
using ActionType = UnityEngine.XR.OpenXR.Features.OpenXRInteractionFeature.ActionType;
using DeviceConfig = UnityEngine.XR.OpenXR.Features.OpenXRInteractionFeature.DeviceConfig;

namespace UnityShim
{
    /// <summary>A runtime of OpenXR as Unity's plug-in drives it: it asks the features that are switched on for their
    /// actions, and reports the devices that users take by their profiles.</summary>
    public static class OpenXrRuntime
    {
        internal static HashSet<string> Extensions { get; } = new HashSet<string>();

        internal static List<OpenXRInteractionFeature.ActionMapConfig> Maps { get; } =
            new List<OpenXRInteractionFeature.ActionMapConfig>();

        internal static bool IsRunning { get; private set; }

        /// <summary>Starts the application on a headset that has some extensions.</summary>
        public static void Start(params string[] extensions)
        {
            Extensions.UnionWith(extensions);
            IsRunning = true;
            OpenXRInteractionFeature[] features = OpenXRSettings.Instance.GetFeatures<OpenXRInteractionFeature>()
                .Where(feature => feature.enabled).Cast<OpenXRInteractionFeature>().ToArray();
            foreach (OpenXRInteractionFeature feature in features)
            {
                feature.Create();
            }
            Maps.AddRange(features.Where(feature => feature.enabled).SelectMany(feature => feature.CreateActionMaps()));
        }

        /// <summary>Puts a device of a profile into a hand.</summary>
        /// <exception cref="InvalidOperationException">No feature or more than one has actions for that profile.</exception>
        public static OpenXrDevice Take(string profile, string userPath)
        {
            OpenXRInteractionFeature.ActionMapConfig map = Maps.Single(each => each.desiredInteractionProfile == profile);
            return new OpenXrDevice(map, map.deviceInfos!.Single(each => each.userPath == userPath));
        }

        internal static void Reset()
        {
            IsRunning = false;
            Extensions.Clear();
            Maps.Clear();
            OpenXRSettings.Groups.Clear();
            InputSystem.Layouts.Clear();
        }
    }

    /// <summary>A device of OpenXR in the Input System. Its state is a row of bytes: the values of all actions in their
    /// order, each number of four bytes at a multiple of four. Controls of its layout are at the place of the action with
    /// their name, others at the offset that the layout gives them.</summary>
    public sealed class OpenXrDevice
    {
        private static readonly (string Name, Type Control, uint Bytes)[] PoseParts =
        {
            ("isTracked", typeof(ButtonControl), 1u),
            ("trackingState", typeof(IntegerControl), 4u),
            ("position", typeof(Vector3Control), 12u),
            ("rotation", typeof(QuaternionControl), 16u),
            ("velocity", typeof(Vector3Control), 12u),
            ("angularVelocity", typeof(Vector3Control), 12u),
        };

        private readonly ActionMapConfig map;
        private readonly string hand;
        private readonly Dictionary<string, uint> places = new Dictionary<string, uint>(StringComparer.OrdinalIgnoreCase);
        private readonly Dictionary<string, PropertyInfo> properties;
        private uint end;

        internal OpenXrDevice(ActionMapConfig map, DeviceConfig info)
        {
            this.map = map;
            bool isLeft = (info.characteristics & InputDeviceCharacteristics.Left) != 0;
            hand = isLeft ? "<XRController>{LeftHand}/" : "<XRController>{RightHand}/";
            Type type = InputSystem.Layouts.Values
                .Single(each => each.Matches.Matches("XRInputV1", map.localizedName!)).Type;
            properties = ControlsOf(type);
            foreach (ActionConfig action in map.actions!)
            {
                Place(action);
            }
            Device = (XRController)Activator.CreateInstance(type)!;
            Fill(Device, properties);
            foreach ((string name, PropertyInfo property) in properties.Select(pair => (pair.Key, pair.Value)))
            {
                SimulatedInput.SetBoxed(hand + name, Zero(property.PropertyType));
            }
            if (isLeft)
            {
                XRController.Left = Device;
            }
            else
            {
                XRController.Right = Device;
            }
            (isLeft ? XrHand.Left : XrHand.Right).Take(map.localizedName!, true);
            OpenXRInput.Handle = Of("/output/haptic") != null ? 1uL : 0uL;
        }

        /// <summary>The device in the Input System.</summary>
        public XRController Device { get; }

        /// <summary>Sets a number or a button that is not a part of a pose.</summary>
        /// <param name="path">Its path in OpenXR without that of the hand.</param>
        public void Set(string path, float value) => Write(Needed(path).name!, value);

        /// <summary>Moves the device: sets one of its poses, in Unity's frame.</summary>
        public void Move(string path, Vector3 position, Quaternion rotation, bool isTracked = true)
        {
            string pose = Needed(path).name!;
            Write(pose + "/isTracked", isTracked ? 1f : 0f);
            Write(pose + "/trackingState", isTracked ? 3 : 0);
            Write(pose + "/position", position);
            Write(pose + "/rotation", rotation);
        }

        private static Dictionary<string, PropertyInfo> ControlsOf(Type type)
        {
            var found = new Dictionary<string, PropertyInfo>(StringComparer.OrdinalIgnoreCase);
            for (Type? at = type; at != null; at = at.BaseType)
            {
                foreach (PropertyInfo property in at.GetProperties(
                    BindingFlags.Instance | BindingFlags.Public | BindingFlags.DeclaredOnly))
                {
                    if (property.IsDefined(typeof(InputControlAttribute)) && !found.ContainsKey(property.Name))
                    {
                        found.Add(property.Name, property);
                    }
                }
            }
            return found;
        }

        private static void Fill(InputControl owner, Dictionary<string, PropertyInfo> properties)
        {
            foreach ((string name, PropertyInfo property) in properties.Select(pair => (pair.Key, pair.Value)))
            {
                var control = (InputControl)Activator.CreateInstance(property.PropertyType)!;
                control.name = name;
                Fill(control, ControlsOf(property.PropertyType));
                owner.Children.Add(name, control);
            }
            owner.Finish();
        }

        private static object Zero(Type control) => typeof(AxisControl).IsAssignableFrom(control) ? 0f
            : control == typeof(IntegerControl) ? 0
            : control == typeof(Vector3Control) ? Vector3.zero
            : control == typeof(QuaternionControl) ? (object)Quaternion.identity : false;

        private void Place(ActionConfig action)
        {
            switch (action.type)
            {
                case ActionType.Binary:
                    Place(action.name!, 1u);
                    break;
                case ActionType.Axis1D:
                    Place(action.name!, 4u);
                    break;
                case ActionType.Axis2D:
                    Place(action.name!, 8u);
                    break;
                case ActionType.Pose:
                    foreach ((string name, Type control, uint bytes) in PoseParts)
                    {
                        Place(action.name + "/" + name, bytes);
                        SimulatedInput.SetBoxed(hand + action.name + "/" + name, Zero(control));
                    }
                    break;
            }
        }

        private void Place(string name, uint bytes)
        {
            uint start = bytes < 4u ? end : (end + 3u) / 4u * 4u;
            places.Add(name, start);
            end = start + bytes;
        }

        private ActionConfig? Of(string path) =>
            map.actions!.SingleOrDefault(each => each.bindings!.Any(binding => binding.interactionPath == path));

        private ActionConfig Needed(string path) => Of(path) ?? throw new ArgumentException("no action is bound to " + path);

        private void Write(string name, object value)
        {
            SimulatedInput.SetBoxed(hand + name, value);
            foreach ((string other, PropertyInfo property) in properties.Select(pair => (pair.Key, pair.Value)))
            {
                uint offset = property.GetCustomAttribute<InputControlAttribute>()!.offset;
                bool isOwn = places.Keys.Any(each => each.Split('/')[0].Equals(other, StringComparison.OrdinalIgnoreCase));
                if (!isOwn && offset == places[name] && value.GetType() == Zero(property.PropertyType).GetType())
                {
                    SimulatedInput.SetBoxed(hand + other, value);
                }
            }
        }
    }
}
