using System.Collections.Generic;
using System.Linq;
using System.Text.RegularExpressions;
using NUnit.Framework;
using UnityShim;

namespace UnityEngine.TestTools
{
    /// <summary>The log messages that a test expects. As in Unity, an unexpected error fails the test.</summary>
    public static class LogAssert
    {
        private static readonly List<(LogType Type, Regex Text)> Expected = new List<(LogType, Regex)>();

        /// <summary>Whether unexpected errors are ignored in the current test.</summary>
        public static bool ignoreFailingMessages { get; set; }

        public static void Expect(LogType type, string message) => Expect(type, new Regex("^" + Regex.Escape(message) + "$"));

        public static void Expect(LogType type, Regex message) => Expected.Add((type, message));

        internal static void Begin()
        {
            Expected.Clear();
            ignoreFailingMessages = false;
        }

        internal static void End()
        {
            var lines = Log.Lines.ToList();
            foreach ((LogType type, Regex text) in Expected)
            {
                int index = lines.FindIndex(line => line.Type == type && text.IsMatch(line.Text));
                Assert.That(index, Is.GreaterThanOrEqualTo(0), $"expected to be logged as {type}: {text}; logged was:\n" +
                    string.Join("\n", Log.Lines.Select(line => line.Type + ": " + line.Text)));
                lines.RemoveAt(index);
            }
            Assert.That(lines.Where(IsFailure).Select(line => line.Text), Is.Empty, "unexpected errors in the log");
        }

        private static bool IsFailure((LogType Type, string Text) line) => !ignoreFailingMessages &&
            (line.Type == LogType.Error || line.Type == LogType.Exception);
    }
}
