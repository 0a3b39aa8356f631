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

        public string name { get; internal set; } = "";

        internal Dictionary<string, InputControl> Children { get; } = new Dictionary<string, InputControl>();

        public TControl GetChildControl<TControl>(string path)
            where TControl : InputControl => Children.TryGetValue(path, out InputControl? child)
            ? child as TControl ?? throw new ArgumentException(
                $"Expected control '{path}' to be of type '{typeof(TControl)}' but is of type '{child.GetType()}'")
            : throw new KeyNotFoundException($"no control '{path}' in '{name}'");

        internal void Finish() => FinishSetup();

        protected virtual void FinishSetup()
        {
        }
    }

    public abstract class InputControl<TValue> : InputControl
        where TValue : struct
    {
        private readonly Func<TValue>? read;

        private protected InputControl(Func<TValue>? read) => this.read = read;

        public TValue ReadValue() => read?.Invoke() ?? default;
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
    public class AxisControl : InputControl<float>
    {
        public AxisControl()
            : base(null)
        {
        }

        internal AxisControl(Func<float> read)
            : base(read)
        {
        }
    }

    public class ButtonControl : AxisControl
    {
        public ButtonControl()
        {
        }

        internal ButtonControl(Func<bool> read)
            : base(() => read() ? 1f : 0f)
        {
        }

        public bool isPressed => ReadValue() >= 0.5f;
    }

    public class IntegerControl : InputControl<int>
    {
        public IntegerControl()
            : base(null)
        {
        }
    }

    public class Vector2Control : InputControl<Vector2>
    {
        public Vector2Control()
            : base(null)
        {
        }

        internal Vector2Control(Func<Vector2> read)
            : base(read)
        {
        }
    }

    public class Vector3Control : InputControl<Vector3>
    {
        public Vector3Control()
            : base(null)
        {
        }
    }

    public class QuaternionControl : InputControl<Quaternion>
    {
        public QuaternionControl()
            : base(null)
        {
        }
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
