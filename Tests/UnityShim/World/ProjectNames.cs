using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace UnityShim
{
    /// <summary>Tags and layers of a project as Unity makes it.</summary>
    public static class ProjectNames
    {
        /// <summary>Empty where a layer has no name.</summary>
        public static readonly string[] Layers = LayersOfNewProject();

        /// <summary>Those that every project has.</summary>
        public static readonly IReadOnlyList<string> Tags = new[]
        {
            "Untagged", "Respawn", "Finish", "EditorOnly", "MainCamera", "Player", "GameController",
        };

        /// <exception cref="UnityException">As in Unity, where a tag is set or compared that the project does not
        /// have.</exception>
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
