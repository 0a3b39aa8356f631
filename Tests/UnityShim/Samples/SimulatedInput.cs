using System.Collections.Generic;
using UnityEngine;

namespace UnityShim
{
    /// <summary>What a test's hand does: mouse, graphics pen, and controls of tracked devices by their paths.</summary>
    public static class SimulatedInput
    {
        private static readonly Dictionary<string, object> Values = new Dictionary<string, object>();

        /// <summary>Pixels from the lower left corner.</summary>
        public static Vector3 MousePosition { get; set; }

        public static bool MouseButton { get; set; }

        /// <summary>Null where there is no graphics pen; 0 for one in the air.</summary>
        public static float? PenPressure { get; set; }

        /// <summary>Of the old Input Manager: goes down in this frame.</summary>
        public static KeyCode KeyDown { get; set; }

        public static void SetControl<TValue>(string path, TValue value)
            where TValue : struct => Values[path] = value;

        public static void Reset()
        {
            Values.Clear();
            MousePosition = default;
            MouseButton = false;
            PenPressure = null;
            KeyDown = KeyCode.None;
        }

        internal static object? Control(string path) => Values.TryGetValue(path, out object value) ? value : null;
    }
}

namespace UnityEngine
{
    public partial class Input
    {
        public static Vector3 mousePosition => UnityShim.SimulatedInput.MousePosition;

        public static bool GetMouseButton(int button) => button == 0 && UnityShim.SimulatedInput.MouseButton;

        public static bool GetKeyDown(KeyCode key) => UnityShim.SimulatedInput.KeyDown == key;
    }
}
