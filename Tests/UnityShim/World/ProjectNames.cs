using System.Collections.Generic;
using System.IO;
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

    /// <summary>The folders of a player.</summary>
    public static class ProjectFolders
    {
        /// <summary>The folder that the test sets, else a temporary one.</summary>
        public static string Persistent { get; set; } =
            Path.Combine(Path.GetTempPath(), "haptoflow-shim-" + Path.GetRandomFileName());
    }

    /// <summary>Records the messages of scripts.</summary>
    public static class Log
    {
        private static readonly List<(LogType Type, string Text)> Written = new List<(LogType, string)>();

        /// <summary>Raised for the messages of all threads, unlike in Unity, which raises it for the main thread only.
        /// </summary>
        internal static event Application.LogCallback? Received;

        public static IReadOnlyList<(LogType Type, string Text)> Lines => Written;

        /// <summary>The number of messages that contain a text, of one type or of all.</summary>
        public static int Count(string part, LogType? type = null)
        {
            int count = 0;
            foreach ((LogType of, string text) in Written)
            {
                count += (type ?? of) == of && text.Contains(part) ? 1 : 0;
            }
            return count;
        }

        public static void Clear()
        {
            lock (Written)
            {
                Written.Clear();
            }
        }

        internal static void Write(LogType type, object message)
        {
            lock (Written)
            {
                Written.Add((type, message.ToString() ?? ""));
            }
            Received?.Invoke(message.ToString() ?? "", "", type);
        }
    }
}
