using UnityEngine;
using UnityShim;

namespace UnityEditor
{
    public sealed partial class EditorGUIUtility : GUIUtility
    {
        public static float singleLineHeight => 18f;
        public static float standardVerticalSpacing => 2f;
        public static float labelWidth { get; set; } = 150f;
        public static bool isProSkin => EditorSession.DarkSkin;

        public static void PingObject(Object? obj) => EditorSession.Pinged = obj;

        public static GUIContent IconContent(string name) => new GUIContent("", new Texture { name = name });
    }

    public sealed partial class ObjectNames
    {
        public static string NicifyVariableName(string name) =>
            System.Text.RegularExpressions.Regex.Replace(name, "(?<=[a-z])(?=[A-Z])", " ");
    }

    public sealed partial class EditorStyles
    {
        public static GUIStyle label { get; } = "Label";
        public static GUIStyle boldLabel { get; } = "BoldLabel";
        public static GUIStyle miniLabel { get; } = "MiniLabel";
        public static GUIStyle miniButton { get; } = "MiniButton";
        public static GUIStyle wordWrappedLabel { get; } = "WordWrappedLabel";
        public static GUIStyle wordWrappedMiniLabel { get; } = "WordWrappedMiniLabel";
        public static GUIStyle helpBox { get; } = "HelpBox";
        public static GUIStyle toolbar { get; } = "Toolbar";
        public static GUIStyle toolbarButton { get; } = "ToolbarButton";
        public static GUIStyle linkLabel { get; } = "LinkLabel";
    }
}

namespace UnityEngine
{
    public partial class GUIUtility
    {
    }
}
