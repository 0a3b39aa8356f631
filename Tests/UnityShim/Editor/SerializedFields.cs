using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Reflection;
using UnityEngine;
using Object = UnityEngine.Object;

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
