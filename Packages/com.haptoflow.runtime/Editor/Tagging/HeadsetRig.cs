#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow.Editor
{
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
