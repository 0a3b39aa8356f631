using System.Collections.Generic;
using UnityEngine;

namespace UnityShim
{
    /// <summary>What the scripts logged.</summary>
    public static class Log
    {
        private static readonly List<(LogType Type, string Text)> Written = new List<(LogType, string)>();

        /// <summary>Unity tells of the main thread's messages only; here of everybody's.</summary>
        internal static event Application.LogCallback? Received;

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
            Received?.Invoke(message.ToString() ?? "", "", type);
        }
    }
}
