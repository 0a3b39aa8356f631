using System.Collections.Generic;
using UnityEngine;

namespace UnityShim
{
    /// <summary>The simulated input: mouse, graphics pen, and the controls of tracked devices by their paths.</summary>
    public static class SimulatedInput
    {
        private static readonly Dictionary<string, object> Values = new Dictionary<string, object>();

        /// <summary>The position of the mouse, in pixels from the lower left corner.</summary>
        public static Vector3 MousePosition { get; set; }

        public static bool MouseButton { get; set; }

        /// <summary>The pressure of the graphics pen: null without a pen, 0 for a pen in the air.</summary>
        public static float? PenPressure { get; set; }

        /// <summary>The key of the old Input Manager that goes down in this frame.</summary>
        public static KeyCode KeyDown { get; set; }

        public static void SetControl<TValue>(string path, TValue value)
            where TValue : struct => Values[path] = value;

        internal static void SetBoxed(string path, object value) => Values[path] = value;

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
