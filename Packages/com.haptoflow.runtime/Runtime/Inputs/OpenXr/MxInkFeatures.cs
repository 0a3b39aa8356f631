#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEngine;
using UnityEngine.XR.OpenXR;
using UnityEngine.XR.OpenXR.Features;

namespace HaptoFlow
{
    /// <summary>The OpenXR features that bring an interaction profile of MX Ink, from whichever package.</summary>
    internal static class MxInkFeatures
    {
        /// <summary>The extension of OpenXR that defines the profile.</summary>
        public const string Extension = "XR_LOGITECH_mx_ink_stylus_interaction";

        /// <summary>Those that are switched on for a build target.</summary>
        public static IEnumerable<OpenXRFeature> SwitchedOn(OpenXRSettings settings) => settings
            .GetFeatures<OpenXRInteractionFeature>()
            .Where(feature => feature.enabled && Requests(feature));

        // Unity's plug-in stores the extensions that a feature requests in a field that it does not publish.
        private static bool Requests(OpenXRFeature feature) => JsonUtility.ToJson(feature).Contains(Extension);
    }
}
