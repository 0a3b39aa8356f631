using System.Collections.Generic;
using UnityEngine;

namespace UnityShim
{
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
