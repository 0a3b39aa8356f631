#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Model;

namespace HaptoFlow.Studies
{
    /// <summary>The first place where two JSON values differ.</summary>
    internal static class JsonDifference
    {
        /// <returns>The place and both values; null where they are equal. Members of the second that the first does not
        /// have are a difference too.</returns>
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
                    return (member.Value.Path, "not there", JsonText.Of(member.Value));
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
                    return (member.Value.Path, JsonText.Of(member.Value), "not there");
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
