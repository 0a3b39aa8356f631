using System;
using System.Collections;
using System.Collections.Generic;
using UnityShim;

namespace UnityEngine.InputSystem
{
    public enum InputActionType
    {
        Value = 0,
        Button = 1,
        PassThrough = 2,
    }

    public sealed partial class InputAction : IDisposable
    {
        private readonly string? path;

        public InputAction(string? name = null, InputActionType type = default, string? binding = null,
            string? interactions = null, string? processors = null, string? expectedControlType = null) =>
            path = binding;

        /// <summary>The controls of connected devices that match the binding. The test sets the value of an action
        /// without a binding.</summary>
        public Utilities.ReadOnlyArray<InputControl> controls
        {
            get
            {
                bool found = path == null || SimulatedInput.Control(path) != null;
                return new Utilities.ReadOnlyArray<InputControl>(found ? new InputControl[] { new BoundControl() } : null);
            }
        }

        public Utilities.ReadOnlyArray<InputBinding> bindings => new Utilities.ReadOnlyArray<InputBinding>(
            path != null ? new[] { new InputBinding { path = path } } : null);

        public void Dispose() => Disable();

        private object? ReadBinding() => path != null ? SimulatedInput.Control(path) : null;
    }

    public struct InputBinding
    {
        public string path { get; set; }

        public string effectivePath => path;
    }

    public abstract class InputControl
    {
        public string displayName { get; protected set; } = "";
    }

    internal sealed class BoundControl : InputControl
    {
    }

    public sealed class Mouse
    {
        private static readonly Mouse Only = new Mouse();

        public static Mouse? current => Only;

        public Controls.Vector2Control position { get; } = new Controls.Vector2Control(
            () => new Vector2(SimulatedInput.MousePosition.x, SimulatedInput.MousePosition.y));

        public Controls.ButtonControl leftButton { get; } =
            new Controls.ButtonControl(() => SimulatedInput.MouseButton);
    }

    public sealed class Pen
    {
        private static readonly Pen Only = new Pen();

        public static Pen? current => SimulatedInput.PenPressure.HasValue ? Only : null;

        public Controls.Vector2Control position { get; } = new Controls.Vector2Control(
            () => new Vector2(SimulatedInput.MousePosition.x, SimulatedInput.MousePosition.y));

        public Controls.AxisControl pressure { get; } =
            new Controls.AxisControl(() => SimulatedInput.PenPressure ?? 0f);

        public Controls.ButtonControl tip { get; } = new Controls.ButtonControl(() => SimulatedInput.PenPressure > 0f);
    }
}

namespace UnityEngine.InputSystem.Controls
{
    public class Vector2Control
    {
        private readonly Func<Vector2> read;

        internal Vector2Control(Func<Vector2> read) => this.read = read;

        public Vector2 ReadValue() => read();
    }

    public class AxisControl
    {
        private readonly Func<float> read;

        internal AxisControl(Func<float> read) => this.read = read;

        public float ReadValue() => read();
    }

    public class ButtonControl
    {
        private readonly Func<bool> read;

        internal ButtonControl(Func<bool> read) => this.read = read;

        public bool isPressed => read();
    }
}

namespace UnityEngine.InputSystem.Utilities
{
    public struct ReadOnlyArray<TValue> : IReadOnlyList<TValue>
    {
        private readonly TValue[]? all;

        internal ReadOnlyArray(TValue[]? all) => this.all = all;

        public int Count => all?.Length ?? 0;
        public TValue this[int index] => all![index];

        IEnumerator<TValue> IEnumerable<TValue>.GetEnumerator() =>
            ((IEnumerable<TValue>)(all ?? Array.Empty<TValue>())).GetEnumerator();
        IEnumerator IEnumerable.GetEnumerator() => (all ?? Array.Empty<TValue>()).GetEnumerator();
    }
}

namespace UnityEngine.InputSystem.XR
{
    /// <summary>Moves its object to the position and rotation of two actions.</summary>
    public class TrackedPoseDriver : MonoBehaviour
    {
        public InputActionProperty positionInput { get; set; }
        public InputActionProperty rotationInput { get; set; }

        private void Update()
        {
            transform.localPosition = positionInput.action?.ReadValue<Vector3>() ?? Vector3.zero;
            transform.localRotation = rotationInput.action?.ReadValue<Quaternion>() ?? Quaternion.identity;
        }
    }
}
