using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public partial class EditorWindow : ScriptableObject
    {
        private static readonly List<EditorWindow> Open = new List<EditorWindow>();

        public GUIContent titleContent { get; set; } = new GUIContent();

        public Vector2 minSize { get; set; }

        public Rect position { get; set; } = new Rect(0f, 0f, 800f, 600f);

        public bool wantsMouseMove { get; set; }

        public static T GetWindow<T>()
            where T : EditorWindow
        {
            T? window = Open.OfType<T>().FirstOrDefault();
            if (window is null)
            {
                window = CreateInstance<T>();
                Open.Add(window);
            }
            return window;
        }

        public void Close()
        {
            Open.Remove(this);
            DestroyImmediate(this);
        }

        public void Repaint()
        {
        }
    }

    [AttributeUsage(AttributeTargets.Method, AllowMultiple = true)]
    public sealed partial class MenuItem : Attribute
    {
        public string menuItem;
        public bool validate;
        public int priority;

        public MenuItem(string itemName)
            : this(itemName, false)
        {
        }

        public MenuItem(string itemName, bool isValidateFunction)
            : this(itemName, isValidateFunction, 1000)
        {
        }

        public MenuItem(string itemName, bool isValidateFunction, int priority)
        {
            menuItem = itemName;
            validate = isValidateFunction;
            this.priority = priority;
        }
    }

    public sealed partial class MenuCommand
    {
        public Object? context;
        public int userData;

        public MenuCommand(Object? inContext) => context = inContext;
    }

    public sealed partial class GameObjectUtility
    {
        public static void SetParentAndAlign(GameObject child, GameObject? parent)
        {
            if (parent != null)
            {
                child.transform.SetParent(parent.transform, false);
                child.layer = parent.layer;
            }
        }
    }
}

namespace UnityEditor.Overlays
{
    [AttributeUsage(AttributeTargets.Class, Inherited = false)]
    public sealed partial class OverlayAttribute : Attribute
    {
        public OverlayAttribute(Type editorWindowType, string id, string displayName, bool defaultDisplay = false)
        {
            this.editorWindowType = editorWindowType;
            this.id = id;
            this.displayName = displayName;
            this.defaultDisplay = defaultDisplay;
        }

        public Type editorWindowType { get; set; }

        public string id { get; set; }

        public string displayName { get; set; }

        public bool defaultDisplay { get; set; }
    }

    public abstract partial class Overlay
    {
        public bool displayed { get; set; }

        public virtual void OnCreated()
        {
        }

        public virtual void OnWillBeDestroyed()
        {
        }
    }

    public abstract partial class IMGUIOverlay : Overlay
    {
        public abstract void OnGUI();
    }
}
