using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using UnityEditor;
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

        public static bool HasOpenInstances<T>()
            where T : EditorWindow => Open.Exists(window => window is T);

        public void ShowNotification(GUIContent notification) => WindowHost.Notification = notification.text;

        /// <summary>Draws one pass with this event.</summary>
        public bool SendEvent(Event e)
        {
            Event.current = e;
            WindowHost.Draw(this);
            return e.type == EventType.Used;
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

    public partial class CustomEditor : Attribute
    {
        private readonly Type inspectedType;
        private readonly bool editorForChildClasses;

        public CustomEditor(Type inspectedType)
            : this(inspectedType, false)
        {
        }

        public CustomEditor(Type inspectedType, bool editorForChildClasses)
        {
            this.inspectedType = inspectedType;
            this.editorForChildClasses = editorForChildClasses;
        }

        internal bool Inspects(Type type) =>
            inspectedType == type || (editorForChildClasses && inspectedType.IsAssignableFrom(type));
    }

    [AttributeUsage(AttributeTargets.Class, Inherited = false)]
    public sealed partial class CanEditMultipleObjects : Attribute
    {
    }

    [AttributeUsage(AttributeTargets.Class, AllowMultiple = true)]
    public sealed partial class CustomPropertyDrawer : Attribute
    {
        internal readonly Type DrawnType;

        public CustomPropertyDrawer(Type type) => DrawnType = type;
    }

    public abstract partial class GUIDrawer
    {
    }

    public abstract partial class PropertyDrawer : GUIDrawer
    {
        public virtual void OnGUI(Rect position, SerializedProperty property, GUIContent label) =>
            EditorScreen.Add(DrawnKind.Label, label.text, "No GUI Implemented");

        public virtual float GetPropertyHeight(SerializedProperty property, GUIContent label) =>
            EditorGUIUtility.singleLineHeight;
    }

    public partial class Editor : ScriptableObject
    {
        private Object[] inspected = Array.Empty<Object>();
        private SerializedObject? serialized;

        public Object target
        {
            get => inspected[0];
            set => inspected = new[] { value };
        }

        public Object[] targets => inspected;

        public SerializedObject serializedObject => serialized ??= new SerializedObject(inspected);

        public static Editor CreateEditor(Object[] targetObjects)
        {
            Type type = EditorTypes.All.FirstOrDefault(candidate => candidate.GetCustomAttributes<CustomEditor>()
                .Any(found => found.Inspects(targetObjects[0].GetType()))) ?? typeof(Editor);
            if (targetObjects.Length > 1 && type.GetCustomAttribute<CanEditMultipleObjects>() == null)
            {
                throw new InvalidOperationException($"{type} cannot edit several objects");
            }
            var editor = (Editor)Activator.CreateInstance(type, true);
            editor.inspected = targetObjects;
            editor.Prepare();
            Messages.Of(editor).Send(Message.OnEnable);
            return editor;
        }

        public virtual void OnInspectorGUI() => DrawDefaultInspector();

        public bool DrawDefaultInspector()
        {
            serializedObject.Update();
            foreach (string path in SerializedFields.Visible(target.GetType()))
            {
                EditorGUILayout.PropertyField(serializedObject.FindProperty(path));
            }
            return serializedObject.ApplyModifiedProperties();
        }

        public virtual bool RequiresConstantRepaint() => false;

        public void Repaint()
        {
        }

        internal virtual void Prepare()
        {
        }
    }

    /// <summary>Records groups of changes that can be undone. Redo is left out, because no test needs it.</summary>
    public partial class Undo
    {
        private static readonly List<(int Group, Action Revert)> Steps = new List<(int, Action)>();
        private static int group;

        public delegate void UndoRedoCallback();

        public static UndoRedoCallback? undoRedoPerformed;

        public static int GetCurrentGroup() => group;

        public static void IncrementCurrentGroup() => ++group;

        public static void SetCurrentGroupName(string name)
        {
        }

        public static void RecordObject(Object objectToUndo, string name) =>
            RecordObjects(new[] { objectToUndo }, name);

        public static void RecordObjects(Object[] objectsToUndo, string name)
        {
            foreach (Object target in objectsToUndo)
            {
                if (target is Transform place)
                {
                    (Vector3 position, Quaternion rotation, Vector3 scale) =
                        (place.localPosition, place.localRotation, place.localScale);
                    Push(() => (place.localPosition, place.localRotation, place.localScale) =
                        (position, rotation, scale));
                    continue;
                }
                Dictionary<string, object?> before = SerializedFields.Snapshot(target);
                Push(() => SerializedFields.Restore(target, before));
            }
        }

        public static T AddComponent<T>(GameObject gameObject)
            where T : Component
        {
            T added = gameObject.AddComponent<T>();
            Push(() => Object.DestroyImmediate(added));
            return added;
        }

        public static void RegisterCreatedObjectUndo(Object objectToUndo, string name) =>
            Push(() => Object.DestroyImmediate(objectToUndo));

        public static void CollapseUndoOperations(int groupIndex)
        {
            for (int index = 0; index < Steps.Count; ++index)
            {
                if (Steps[index].Group > groupIndex)
                {
                    Steps[index] = (groupIndex, Steps[index].Revert);
                }
            }
            group = Math.Max(group, groupIndex);
        }

        /// <summary>Undoes the last group.</summary>
        public static void PerformUndo()
        {
            if (Steps.Count > 0)
            {
                int last = Steps.Max(step => step.Group);
                foreach ((_, Action revert) in Steps.Where(each => each.Group == last).Reverse())
                {
                    revert();
                }
                Steps.RemoveAll(step => step.Group == last);
                undoRedoPerformed?.Invoke();
            }
            ++group;
        }

        internal static void Reset() => Steps.Clear();

        private static void Push(Action revert) => Steps.Add((group, revert));
    }
}

namespace UnityEditor.Overlays
{
    [AttributeUsage(AttributeTargets.Class, Inherited = false)]
    public sealed partial class OverlayAttribute : Attribute
    {
        public OverlayAttribute(Type editorWindowType, string id, string displayName, bool defaultDisplay = false)
        {
        }
    }

    public abstract partial class Overlay
    {
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

namespace UnityShim
{
    /// <summary>Simulates the editor around a window, and the user's answers to its dialogs.</summary>
    public static class WindowHost
    {
        /// <summary>The pixels per point of the screen.</summary>
        public static float PixelsPerPoint { get; set; } = 1f;

        /// <summary>Returns the path to save to from the proposed name; null to cancel.</summary>
        public static Func<string, string>? AnswerToSave { get; set; }

        /// <summary>Returns the file to open; null to cancel.</summary>
        public static Func<string>? AnswerToOpen { get; set; }

        /// <summary>The notification that a window showed last.</summary>
        public static string Notification { get; internal set; } = "";

        /// <summary>Runs an update of the editor, of which there are about a hundred a second.</summary>
        public static void Update()
        {
            EditorApplication.RunDelayed();
            EditorApplication.update?.Invoke();
        }

        public static void Close(EditorWindow window)
        {
            Messages messages = Messages.Of(window);
            messages.Send(Message.OnDisable);
            messages.Send(Message.OnDestroy);
            window.Close();
        }

        /// <summary>Simulates a domain reload for a window: serialised fields keep their values, all others are reset.
        /// </summary>
        public static void Reload(EditorWindow window)
        {
            Messages messages = Messages.Of(window);
            EditorSession.ReloadScripts();
            messages.Send(Message.OnDisable);
            messages.Send(Message.OnEnable);
        }

        /// <summary>Draws one pass with the current event.</summary>
        public static IReadOnlyList<Drawn> Draw(EditorWindow window)
        {
            const BindingFlags any = BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;
            MethodInfo draw = window.GetType().GetMethod("OnGUI", any) ??
                throw new InvalidOperationException(window.GetType().Name + " draws nothing");
            return EditorScreen.Draw((Action)Delegate.CreateDelegate(typeof(Action), window, draw));
        }
    }
}
