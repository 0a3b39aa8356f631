namespace UnityEngine.InputSystem
{
    public sealed partial class InputAction
    {
        internal float Value;

        public bool enabled { get; private set; }

        public void Enable() => enabled = true;

        public void Disable() => enabled = false;

        public TValue ReadValue<TValue>()
            where TValue : struct => enabled && (ReadBinding() ?? Value) is TValue value ? value : default;
    }

    public class InputActionReference : ScriptableObject
    {
        public InputAction action { get; } = new InputAction();
    }

    public struct InputActionProperty
    {
        private readonly InputAction? own;

        public InputActionProperty(InputAction action)
        {
            own = action;
            reference = null;
        }

        public InputActionReference? reference { get; }

        public InputAction? action => reference != null ? reference.action : own;
    }
}
