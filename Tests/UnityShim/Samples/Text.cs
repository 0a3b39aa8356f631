namespace UnityEngine
{
    public enum TextAnchor
    {
        UpperLeft = 0,
        UpperCenter = 1,
        UpperRight = 2,
        MiddleLeft = 3,
        MiddleCenter = 4,
        MiddleRight = 5,
        LowerLeft = 6,
        LowerCenter = 7,
        LowerRight = 8,
    }

    public enum TextAlignment
    {
        Left = 0,
        Center = 1,
        Right = 2,
    }

    public sealed partial class Font : Object
    {
        public Material material { get; set; } = new Material();
    }

    public sealed partial class TextMesh : Component
    {
        public string text { get; set; } = "";
        public Font font { get; set; } = null!;
        public int fontSize { get; set; }
        public TextAlignment alignment { get; set; }
        public TextAnchor anchor { get; set; }
        public float characterSize { get; set; } = 1f;
        public Color color { get; set; } = Color.white;
    }

    public sealed partial class Resources
    {
        /// <summary>Unity has a few built-in resources under fixed names, and returns null for any other name.
        /// </summary>
        public static T GetBuiltinResource<T>(string path)
            where T : Object =>
            typeof(T) == typeof(Font) && path == "LegacyRuntime.ttf" ? (T)(Object)new Font() : null!;
    }
}
