using System;
using System.Linq;
using System.Reflection;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace UnityEditor
{
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

        public static Editor CreateEditor(Object targetObject) => CreateEditor(new[] { targetObject });

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
}
