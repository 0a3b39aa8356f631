using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityShim
{
    /// <summary>What Unity would serialize of an object: public fields and those marked so, nested classes unfolded.
    /// </summary>
    internal static class SerializedFields
    {
        private const BindingFlags OwnFields =
            BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.DeclaredOnly;

        public static IEnumerable<string> Roots(Type type) => FieldsOf(type).Select(field => field.Name);

        /// <summary>Null where there is no such field.</summary>
        public static FieldInfo? Find(Type type, string path)
        {
            FieldInfo? found = null;
            foreach (string name in path.Split('.'))
            {
                found = FieldsOf(found?.FieldType ?? type).FirstOrDefault(field => field.Name == name);
                if (found == null)
                {
                    return null;
                }
            }
            return found;
        }

        /// <summary>Paths of everything that is a value of its own.</summary>
        public static IEnumerable<string> Leaves(Type type) => FieldsOf(type).SelectMany(field =>
            IsNested(field.FieldType)
                ? Leaves(field.FieldType).Select(path => field.Name + "." + path)
                : new[] { field.Name });

        public static object? Get(object owner, string path)
        {
            object? value = owner;
            foreach (string name in path.Split('.'))
            {
                value = Find(value!.GetType(), name)!.GetValue(value);
            }
            return value;
        }

        public static void Set(object owner, string path, object? value)
        {
            int last = path.LastIndexOf('.');
            object holder = last < 0 ? owner : Get(owner, path.Substring(0, last))!;
            Find(holder.GetType(), path.Substring(last + 1))!.SetValue(holder, value);
        }

        /// <summary>A copy of all values that no later change of the object changes.</summary>
        public static Dictionary<string, object?> Snapshot(Object target) =>
            Leaves(target.GetType()).ToDictionary(path => path, path => Get(target, path));

        public static void Restore(Object target, Dictionary<string, object?> snapshot)
        {
            foreach (KeyValuePair<string, object?> entry in snapshot)
            {
                Set(target, entry.Key, entry.Value);
            }
            Messages.Validate(target);
        }

        public static bool IsNested(Type type) => type.IsClass && type != typeof(string) && !type.IsArray &&
            type.IsDefined(typeof(SerializableAttribute), false);

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
