#nullable enable
using System.Collections;
using System.Collections.Generic;

namespace HaptoFlow.Studies
{
    /// <summary>Keys and values of a sidecar in their order: texts, numbers, truths, lists of them, further fields.
    /// Made with a collection initialiser.</summary>
    public sealed class StudyFields : IEnumerable<KeyValuePair<string, object?>>
    {
        private readonly List<KeyValuePair<string, object?>> members = new List<KeyValuePair<string, object?>>();

        /// <summary>One more key.</summary>
        public void Add(string key, object? value) => members.Add(new KeyValuePair<string, object?>(key, value));

        /// <inheritdoc/>
        public IEnumerator<KeyValuePair<string, object?>> GetEnumerator() => members.GetEnumerator();

        IEnumerator IEnumerable.GetEnumerator() => members.GetEnumerator();
    }
}
