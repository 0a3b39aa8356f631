#nullable enable
using System;
using System.Collections.Generic;
using Object = UnityEngine.Object;

namespace HaptoFlow
{
    /// <summary>Values by Unity objects. Destroyed objects are removed whenever the number of entries has doubled, so a
    /// scene that spawns for hours keeps at most twice what lives in it. Main thread; makes garbage only while it
    /// grows.</summary>
    internal sealed class ObjectCache<TKey, TValue>
        where TKey : Object
    {
        private const int MinimumBeforeSweep = 256;
        private readonly Dictionary<TKey, TValue> entries = new Dictionary<TKey, TValue>();
        private readonly List<TKey> gone = new List<TKey>();
        private int sweepAt = MinimumBeforeSweep;

        public int Count => entries.Count;

        public Dictionary<TKey, TValue>.ValueCollection Values => entries.Values;

        public bool TryGetValue(TKey key, out TValue value) => entries.TryGetValue(key, out value!);

        public void Set(TKey key, TValue value)
        {
            if (entries.Count >= sweepAt && !entries.ContainsKey(key))
            {
                Sweep();
            }
            entries[key] = value;
        }

        public void Remove(TKey key) => entries.Remove(key);

        public void Clear()
        {
            entries.Clear();
            sweepAt = MinimumBeforeSweep;
        }

        /// <summary>Removes destroyed objects now. What values reference, such as meshes, Unity cannot unload
        /// before.</summary>
        public void Sweep()
        {
            foreach (TKey key in entries.Keys)
            {
                if (key == null)
                {
                    gone.Add(key!);
                }
            }
            foreach (TKey key in gone)
            {
                entries.Remove(key);
            }
            gone.Clear();
            sweepAt = Math.Max(MinimumBeforeSweep, 2 * entries.Count);
        }
    }
}
