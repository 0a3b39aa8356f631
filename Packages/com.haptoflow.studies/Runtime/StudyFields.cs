#nullable enable
using System.Collections;
using System.Collections.Generic;

namespace HaptoFlow.Studies
{
    /// <summary>Ordered keys and values of a sidecar: texts, numbers, booleans, lists of them, or further fields. Use a
    /// collection initialiser.</summary>
    public sealed class StudyFields : IEnumerable<KeyValuePair<string, object?>>
    {
        private readonly List<KeyValuePair<string, object?>> members = new List<KeyValuePair<string, object?>>();

        /// <summary>Adds a key with its value.</summary>
        public void Add(string key, object? value) => members.Add(new KeyValuePair<string, object?>(key, value));

        /// <inheritdoc/>
        public IEnumerator<KeyValuePair<string, object?>> GetEnumerator() => members.GetEnumerator();

        IEnumerator IEnumerable.GetEnumerator() => members.GetEnumerator();
    }
}
