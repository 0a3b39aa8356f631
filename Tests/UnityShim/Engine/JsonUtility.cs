using System.Linq;
using UnityShim;

namespace UnityEngine
{
    public static class JsonUtility
    {
        /// <summary>The serialised fields by their names; the shim writes each value as a text.</summary>
        public static string ToJson(object obj) => "{" + string.Join(",", SerializedFields.Leaves(obj)
            .Select(path => $"\"{path}\":\"{SerializedFields.Get(obj, path)}\"")) + "}";
    }
}
