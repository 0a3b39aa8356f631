using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace UnityShim
{
    /// <summary>Tags and layers of a new Unity project.</summary>
    public static class ProjectNames
    {
        /// <summary>The names of the layers; empty for a layer without a name.</summary>
        public static readonly string[] Layers = LayersOfNewProject();

        /// <summary>The tags that every project has.</summary>
        public static readonly IReadOnlyList<string> Tags = new[]
        {
            "Untagged", "Respawn", "Finish", "EditorOnly", "MainCamera", "Player", "GameController",
        };

        /// <exception cref="UnityException">The project does not have the tag, as in Unity.</exception>
        internal static void RequireTag(string tag)
        {
            if (!Tags.Contains(tag))
            {
                throw new UnityException($"Tag: {tag} is not defined.");
            }
        }

        private static string[] LayersOfNewProject()
        {
            string[] names = Enumerable.Repeat("", 32).ToArray();
            (names[0], names[1], names[2], names[4], names[5]) =
                ("Default", "TransparentFX", "Ignore Raycast", "Water", "UI");
            return names;
        }
    }
}
