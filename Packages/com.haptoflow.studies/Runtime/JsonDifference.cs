#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Model;

namespace HaptoFlow.Studies
{
    /// <summary>Finds the first difference between two JSON values. JToken.DeepEquals does not say where they
    /// differ.</summary>
    internal static class JsonDifference
    {
        /// <returns>Path and both values; null where they are equal. A member that only one of the objects has is a
        /// difference.</returns>
        public static (string Path, string Was, string Is)? Find(JsonValue was, JsonValue now)
        {
            if (was.IsObject && now.IsObject)
            {
                return OfMembers(was.AsObject(), now.AsObject(), now.Path);
            }
            if (was.Elements is { } elements && now.Elements is { } present)
            {
                return OfElements(elements, present, now.Path);
            }
            string before = JsonText.Of(was);
            string after = JsonText.Of(now);
            return string.Equals(before, after, StringComparison.Ordinal) ? null : (now.Path, before, after);
        }

        private static (string Path, string Was, string Is)? OfMembers(
            IReadOnlyDictionary<string, JsonValue> was, IReadOnlyDictionary<string, JsonValue> now, string path)
        {
            foreach (KeyValuePair<string, JsonValue> member in now)
            {
                if (!was.TryGetValue(member.Key, out JsonValue? before))
                {
                    return (member.Value.Path, "missing", JsonText.Of(member.Value));
                }
                (string, string, string)? difference = Find(before, member.Value);
                if (difference != null)
                {
                    return difference;
                }
            }
            foreach (KeyValuePair<string, JsonValue> member in was)
            {
                if (!now.ContainsKey(member.Key))
                {
                    return (member.Value.Path, JsonText.Of(member.Value), "missing");
                }
            }
            return null;
        }

        private static (string Path, string Was, string Is)? OfElements(
            IReadOnlyList<JsonValue> was, IReadOnlyList<JsonValue> now, string path)
        {
            if (was.Count != now.Count)
            {
                return (path, $"{was.Count} long", $"{now.Count} long");
            }
            for (int index = 0; index < now.Count; ++index)
            {
                (string, string, string)? difference = Find(was[index], now[index]);
                if (difference != null)
                {
                    return difference;
                }
            }
            return null;
        }
    }
}
