using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine.InputSystem;
using UnityEngine.XR.OpenXR;
using UnityEngine.XR.OpenXR.Features;

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
}
