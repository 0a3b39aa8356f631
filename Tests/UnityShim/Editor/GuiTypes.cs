using System;
using UnityShim;

namespace UnityEngine
{
    public partial struct Vector2
    {
        public float x;
        public float y;

        public Vector2(float x, float y)
        {
            this.x = x;
            this.y = y;
        }

        public static Vector2 zero => new Vector2(0f, 0f);

        public float magnitude => (float)Math.Sqrt(x * x + y * y);

        public static Vector2 operator +(Vector2 a, Vector2 b) => new Vector2(a.x + b.x, a.y + b.y);
        public static Vector2 operator -(Vector2 a, Vector2 b) => new Vector2(a.x - b.x, a.y - b.y);

        public override string ToString() => FormattableString.Invariant($"({x:F2}, {y:F2})");
    }

    public partial struct Rect
    {
        public Rect(float x, float y, float width, float height) =>
            (this.x, this.y, this.width, this.height) = (x, y, width, height);

        public float x { get; set; }
        public float y { get; set; }
        public float width { get; set; }
        public float height { get; set; }

        public Vector2 position => new Vector2(x, y);
        public float xMax => x + width;

        public bool Contains(Vector2 point) => point.x >= x && point.x < xMax && point.y >= y && point.y < y + height;
    }

    public partial struct Color
    {
        public float r;
        public float g;
        public float b;
        public float a;

        public Color(float r, float g, float b, float a) => (this.r, this.g, this.b, this.a) = (r, g, b, a);

        public Color(float r, float g, float b)
            : this(r, g, b, 1f)
        {
        }

        public static Color white => new Color(1f, 1f, 1f);
        public static Color black => new Color(0f, 0f, 0f);

        public static Color operator +(Color a, Color b) => new Color(a.r + b.r, a.g + b.g, a.b + b.b, a.a + b.a);
        public static Color operator *(float b, Color a) => new Color(b * a.r, b * a.g, b * a.b, b * a.a);
    }

    public partial class Texture : Object
    {
    }

    public partial class GUIContent
    {
        public static GUIContent none = new GUIContent();

        public GUIContent()
            : this("")
        {
        }

        public GUIContent(string text) => this.text = text;

        public GUIContent(string text, string tooltip)
            : this(text) => this.tooltip = tooltip;

        public string text { get; set; }
        public string tooltip { get; set; } = "";
    }

    public sealed partial class GUIStyle
    {
        public GUIStyle()
        {
        }

        public GUIStyle(GUIStyle other)
        {
            name = other.name;
            wordWrap = other.wordWrap;
            richText = other.richText;
            fontSize = other.fontSize;
            alignment = other.alignment;
            clipping = other.clipping;
            padding = other.padding;
        }

        public static GUIStyle none { get; } = new GUIStyle();
        public string name { get; set; } = "";
        public bool wordWrap { get; set; }
        public bool richText { get; set; }
        public int fontSize { get; set; }
        public TextAnchor alignment { get; set; }
        public TextClipping clipping { get; set; } = TextClipping.Clip;
        public RectOffset padding { get; set; } = new RectOffset(0, 0, 0, 0);
        public GUIStyleState normal { get; set; } = new GUIStyleState();

        /// <summary>Every letter is 0.55 of the font's size wide.</summary>
        public Vector2 CalcSize(GUIContent content) =>
            new Vector2(0.55f * fontSize * content.text.Length, 1.2f * fontSize);

        public void Draw(Rect position, GUIContent content, bool isHover, bool isActive, bool on,
            bool hasKeyboardFocus) =>
            ScreenPaint.Add(nameof(Draw), position, GUI.contentColor, content.text);

        public static implicit operator GUIStyle(string str) => new GUIStyle { name = str };
    }

    public sealed partial class GUIStyleState
    {
        public Color textColor { get; set; }
    }

    public enum TextClipping
    {
        Overflow = 0,
        Clip = 1,
    }

    public partial class RectOffset
    {
        public RectOffset(int left, int right, int top, int bottom)
        {
        }
    }

    public sealed partial class GUILayoutOption
    {
        internal GUILayoutOption()
        {
        }
    }

    public enum FocusType
    {
        Keyboard = 1,
        Passive = 2,
    }

    public enum EventType
    {
        MouseDown = 0,
        MouseUp = 1,
        MouseDrag = 3,
        KeyDown = 4,
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

        public bool shift => Has(EventModifiers.Shift);
        public bool control => Has(EventModifiers.Control);
        public bool alt => Has(EventModifiers.Alt);
        public bool command => Has(EventModifiers.Command);

        /// <summary>The event type for a control: Ignore for mouse events that another control has captured.</summary>
        public EventType GetTypeForControl(int controlID)
        {
            bool mouse = type <= EventType.MouseDrag;
            bool foreign = GUIUtility.hotControl != 0 && GUIUtility.hotControl != controlID;
            return mouse && foreign ? EventType.Ignore : type;
        }

        public void Use() => type = EventType.Used;

        private bool Has(EventModifiers one) => (modifiers & one) != 0;
    }
}
