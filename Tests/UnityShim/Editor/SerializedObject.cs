using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Reflection;
using System.Text;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    /// <summary>A working copy of the serialised fields of one or several objects.</summary>
    public partial class SerializedObject : IDisposable
    {
        private readonly Object[] objects;
        private readonly HashSet<string> changed = new HashSet<string>();
        private Dictionary<string, object?>[] values;

        public SerializedObject(Object obj)
            : this(new[] { obj })
        {
        }

        public SerializedObject(Object[] objs)
        {
            if (objs.Length == 0 || objs.Any(each => each == null))
            {
                throw new ArgumentException("Object at index 0 is null");
            }
            objects = objs;
            values = Read();
        }

        public Object targetObject => objects[0];

        public Object[] targetObjects => objects;

        public void Dispose()
        {
        }

        public void Update()
        {
            values = Read();
            changed.Clear();
        }

        public SerializedProperty FindProperty(string propertyPath) =>
            SerializedFields.Find(targetObject.GetType(), propertyPath) is { } found
                ? new SerializedProperty(this, propertyPath, found.Field, found.Type)
                : null!;

        public bool ApplyModifiedProperties()
        {
            if (changed.Count > 0)
            {
                Undo.RecordObjects(objects, "Inspector");
            }
            return ApplyModifiedPropertiesWithoutUndo();
        }

        public bool ApplyModifiedPropertiesWithoutUndo()
        {
            bool any = changed.Count > 0;
            foreach (string path in changed)
            {
                for (int index = 0; index < objects.Length; ++index)
                {
                    SerializedFields.Set(objects[index], path, values[index][path]);
                }
            }
            changed.Clear();
            if (any)
            {
                Array.ForEach(objects, Messages.Validate);
                ObjectChangeEvents.Publish();
            }
            return any;
        }

        internal object? Value(string path) => values[0].TryGetValue(path, out object? value) ? value : null;

        internal bool Differs(string path) => values[0].Keys
            .Where(leaf => leaf == path || leaf.StartsWith(path + ".", StringComparison.Ordinal))
            .Any(leaf => values.Any(
                each => !each.TryGetValue(leaf, out object? other) || !Equals(other, values[0][leaf])));

        internal void SetValue(string path, object? value)
        {
            foreach (Dictionary<string, object?> each in values)
            {
                each[path] = value;
            }
            changed.Add(path);
        }

        private Dictionary<string, object?>[] Read() => objects.Select(SerializedFields.Snapshot).ToArray();
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

        public string displayName => Nicified(field.Name);

        public string tooltip => field.GetCustomAttribute<TooltipAttribute>()?.tooltip ?? "";

        public bool hasMultipleDifferentValues => serializedObject.Differs(propertyPath);

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

namespace UnityShim
{
    /// <summary>The fields that Unity serialises: public ones and those with SerializeField, with the fields of nested
    /// classes.</summary>
    internal static class SerializedFields
    {
        private const BindingFlags OwnFields =
            BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.DeclaredOnly;

        /// <summary>The names of the fields that the default Inspector draws.</summary>
        public static IEnumerable<string> Visible(Type type) => FieldsOf(type)
            .Where(field => !field.IsDefined(typeof(HideInInspector), false)).Select(field => field.Name);

        /// <summary>The field at a path: "rules.Array.data[2].tag" is the tag of the third rule. Null without such a
        /// field.</summary>
        public static (FieldInfo Field, Type Type)? Find(Type type, string path)
        {
            FieldInfo? field = null;
            Type found = type;
            foreach (string name in path.Split('.'))
            {
                if (name == "Array")
                {
                    continue;
                }
                if (name == "size" && IsList(found))
                {
                    found = typeof(int);
                    continue;
                }
                if (name.StartsWith("data[", StringComparison.Ordinal) && IsList(found))
                {
                    found = ElementOf(found);
                    continue;
                }
                field = FieldsOf(found).FirstOrDefault(each => each.Name == name);
                if (field == null)
                {
                    return null;
                }
                found = field.FieldType;
            }
            return (field!, found);
        }

        /// <summary>The paths of all values. The length of a list comes before its elements.</summary>
        public static IEnumerable<string> Leaves(object owner)
        {
            foreach (FieldInfo field in FieldsOf(owner.GetType()))
            {
                object? value = field.GetValue(owner);
                if (IsNested(field.FieldType))
                {
                    foreach (string path in Leaves(value!))
                    {
                        yield return field.Name + "." + path;
                    }
                }
                else if (IsList(field.FieldType))
                {
                    yield return field.Name + ".Array.size";
                    var list = (IList)value!;
                    for (int index = 0; index < list.Count; ++index)
                    {
                        foreach (string path in Leaves(list[index]!))
                        {
                            yield return $"{field.Name}.Array.data[{index}].{path}";
                        }
                    }
                }
                else
                {
                    yield return field.Name;
                }
            }
        }

        public static object? Get(object owner, string path)
        {
            object? value = owner;
            foreach (string name in path.Split('.'))
            {
                value = name == "Array" ? value
                    : name == "size" && value is IList list ? list.Count
                    : name.StartsWith("data[", StringComparison.Ordinal) ? ((IList)value!)[IndexOf(name)]
                    : FieldsOf(value!.GetType()).First(field => field.Name == name).GetValue(value);
            }
            return value;
        }

        public static void Set(object owner, string path, object? value)
        {
            int last = path.LastIndexOf('.');
            object holder = last < 0 ? owner : Get(owner, path.Substring(0, last))!;
            string name = path.Substring(last + 1);
            if (name == "size" && holder is IList list)
            {
                Resize(list, (int)value!);
                return;
            }
            FieldsOf(holder.GetType()).First(field => field.Name == name).SetValue(holder, value);
        }

        /// <summary>A copy of all values, which later changes of the object do not affect.</summary>
        public static Dictionary<string, object?> Snapshot(Object target) =>
            Leaves(target).ToDictionary(path => path, path => Get(target, path));

        public static void Restore(Object target, Dictionary<string, object?> snapshot)
        {
            foreach (KeyValuePair<string, object?> entry in snapshot)
            {
                Set(target, entry.Key, entry.Value);
            }
            Messages.Validate(target);
        }

        public static bool IsNested(Type type) => type.IsClass && type != typeof(string) && !type.IsArray &&
            !(type.IsGenericType && type.GetGenericTypeDefinition() == typeof(List<>)) &&
            type.IsDefined(typeof(SerializableAttribute), false);

        /// <summary>Whether the type is a list of a class whose fields are serialised.</summary>
        public static bool IsList(Type type) => type.IsGenericType &&
            type.GetGenericTypeDefinition() == typeof(List<>) && IsNested(ElementOf(type));

        private static Type ElementOf(Type list) => list.GetGenericArguments()[0];

        private static int IndexOf(string segment) =>
            int.Parse(segment.Substring(5, segment.Length - 6), CultureInfo.InvariantCulture);

        private static void Resize(IList list, int size)
        {
            while (list.Count > size)
            {
                list.RemoveAt(list.Count - 1);
            }
            while (list.Count < size)
            {
                list.Add(Activator.CreateInstance(ElementOf(list.GetType()), true));
            }
        }

        private static IEnumerable<FieldInfo> FieldsOf(Type? type)
        {
            if (type == null || type == typeof(Object) || type == typeof(object))
            {
                return Array.Empty<FieldInfo>();
            }
            bool native = type.Namespace == "UnityEngine" || type.Namespace == "UnityEditor";
            IEnumerable<FieldInfo> own = native
                ? Array.Empty<FieldInfo>()
                : type.GetFields(OwnFields).Where(field =>
                    !field.IsInitOnly && !field.IsNotSerialized &&
                    (field.IsPublic || field.IsDefined(typeof(SerializeField), false)));
            return FieldsOf(type.BaseType).Concat(own);
        }
    }
}
