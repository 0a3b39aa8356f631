using System;
using System.Linq;
using System.Reflection;
using System.Text;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public enum SerializedPropertyType
    {
        Generic = -1,
        Integer = 0,
        Boolean = 1,
        Float = 2,
        String = 3,
        ObjectReference = 5,
        LayerMask = 6,
        Enum = 7,
        Vector2 = 8,
        Vector3 = 9,
    }

    public partial class SerializedProperty : IDisposable
    {
        private readonly FieldInfo field;

        internal SerializedProperty(SerializedObject owner, string path, FieldInfo field, Type type)
        {
            FieldType = type;
            serializedObject = owner;
            propertyPath = path;
            this.field = field;
        }

        public SerializedObject serializedObject { get; }

        public string propertyPath { get; }

        public string name => field.Name;

        public string displayName => Nicified(field.Name);

        public string tooltip => field.GetCustomAttribute<TooltipAttribute>()?.tooltip ?? "";

        public bool hasMultipleDifferentValues => serializedObject.Differs(propertyPath);

        public bool isExpanded { get; set; }

        public SerializedPropertyType propertyType =>
            FieldType == typeof(string) ? SerializedPropertyType.String
            : FieldType == typeof(bool) ? SerializedPropertyType.Boolean
            : FieldType == typeof(int) || FieldType == typeof(uint) ? SerializedPropertyType.Integer
            : FieldType == typeof(float) ? SerializedPropertyType.Float
            : FieldType == typeof(Vector2) ? SerializedPropertyType.Vector2
            : FieldType == typeof(Vector3) ? SerializedPropertyType.Vector3
            : FieldType == typeof(LayerMask) ? SerializedPropertyType.LayerMask
            : FieldType.IsEnum ? SerializedPropertyType.Enum
            : typeof(Object).IsAssignableFrom(FieldType) ? SerializedPropertyType.ObjectReference
            : SerializedPropertyType.Generic;

        public string stringValue
        {
            get => (string)Boxed!;
            set => Change(value);
        }

        public float floatValue
        {
            get => (float)Boxed!;
            set => Change(value);
        }

        public bool boolValue
        {
            get => (bool)Boxed!;
            set => Change(value);
        }

        public int intValue
        {
            get => Boxed is LayerMask mask ? mask.value : (int)Boxed!;
            set => Change(FieldType == typeof(LayerMask) ? (object)(LayerMask)value : value);
        }

        public uint uintValue
        {
            get => (uint)Boxed!;
            set => Change(value);
        }

        /// <summary>The index of the value among the names.</summary>
        public int enumValueIndex
        {
            get => Array.IndexOf(Enum.GetValues(FieldType), Boxed);
            set => Change(Enum.GetValues(FieldType).GetValue(value));
        }

        public Object? objectReferenceValue
        {
            get => (Object?)Boxed;
            set => Change(value);
        }

        public bool isArray => SerializedFields.IsList(FieldType);

        public int arraySize => (int)serializedObject.Value(propertyPath + ".Array.size")!;

        /// <summary>The type of the field. The field may be a list, or an element of one.</summary>
        internal Type FieldType { get; }

        internal object? Boxed
        {
            get => serializedObject.Value(propertyPath);
            set => serializedObject.SetValue(propertyPath, value);
        }

        public SerializedProperty GetArrayElementAtIndex(int index) =>
            serializedObject.FindProperty($"{propertyPath}.Array.data[{index}]");

        public SerializedProperty FindPropertyRelative(string relativePropertyPath) =>
            serializedObject.FindProperty(propertyPath + "." + relativePropertyPath);

        public void Dispose()
        {
        }

        /// <summary>As in Unity, setting the current value changes nothing, unless the targets have different values.
        /// </summary>
        private void Change(object? value)
        {
            if (!Equals(value, Boxed) || hasMultipleDifferentValues)
            {
                Boxed = value;
            }
        }

        /// <summary>Turns "tipRadiusMetres" into "Tip Radius Metres".</summary>
        private static string Nicified(string name)
        {
            var text = new StringBuilder();
            foreach (char letter in name)
            {
                text.Append(text.Length > 0 && char.IsUpper(letter) ? " " : "");
                text.Append(text.Length == 0 ? char.ToUpperInvariant(letter) : letter);
            }
            return string.Concat(text.ToString().Where(letter => letter != '_'));
        }
    }
}
