using System.Collections.Generic;
using UnityEngine;

namespace UnityShim
{
    /// <summary>What the scripts logged.</summary>
    public static class Log
    {
        private static readonly List<(LogType Type, string Text)> Written = new List<(LogType, string)>();

        public static IReadOnlyList<(LogType Type, string Text)> Lines => Written;

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
        }
    }
}
