using System;

namespace UnityEngine
{
    public enum EventType
    {
        MouseDown = 0,
        MouseUp = 1,
        MouseMove = 2,
        MouseDrag = 3,
        KeyDown = 4,
        KeyUp = 5,
        ScrollWheel = 6,
        Repaint = 7,
        Layout = 8,
        Ignore = 11,
        Used = 12,
    }

    public enum KeyCode
    {
        None = 0,
        Return = 13,
        Space = 32,
        Alpha0 = 48,
        A = 97,
        B = 98,
        C = 99,
        E = 101,
        N = 110,
        S = 115,
        Y = 121,
        UpArrow = 273,
        DownArrow = 274,
        RightArrow = 275,
        LeftArrow = 276,
    }

    [Flags]
    public enum EventModifiers
    {
        None = 0,
        Shift = 1,
        Control = 2,
        Alt = 4,
        Command = 8,
        Numeric = 16,
        CapsLock = 32,
        FunctionKey = 64,
    }

    public enum PointerType
    {
        Mouse = 0,
        Touch = 1,
        Pen = 2,
    }

    public sealed partial class Event
    {
        public static Event current { get; set; } = new Event();

        public EventType type { get; set; } = EventType.Ignore;
        public KeyCode keyCode { get; set; }
        public EventModifiers modifiers { get; set; }
        public Vector2 mousePosition { get; set; }
        public int button { get; set; }
        public float pressure { get; set; }
        public PointerType pointerType { get; set; }

        public bool shift
        {
            get => Has(EventModifiers.Shift);
            set => Put(EventModifiers.Shift, value);
        }

        public bool control
        {
            get => Has(EventModifiers.Control);
            set => Put(EventModifiers.Control, value);
        }

        public bool alt
        {
            get => Has(EventModifiers.Alt);
            set => Put(EventModifiers.Alt, value);
        }

        public bool command
        {
            get => Has(EventModifiers.Command);
            set => Put(EventModifiers.Command, value);
        }

        /// <summary>The event type for a control: Ignore for mouse events that another control has captured.</summary>
        public EventType GetTypeForControl(int controlID)
        {
            bool mouse = type <= EventType.MouseDrag;
            bool foreign = GUIUtility.hotControl != 0 && GUIUtility.hotControl != controlID;
            return mouse && foreign ? EventType.Ignore : type;
        }

        public void Use() => type = EventType.Used;

        private bool Has(EventModifiers one) => (modifiers & one) != 0;

        private void Put(EventModifiers one, bool on) => modifiers = on ? modifiers | one : modifiers & ~one;
    }
}
