#nullable enable
using System;
using System.Collections.Generic;
using UnityEditor;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>A remedy for a finding.</summary>
    /// <param name="Caption">The text of its button.</param>
    internal sealed record Repair(string Caption, Action Act);

    /// <summary>A problem of the scene or the project that prevents or degrades haptics.</summary>
    /// <param name="Severity">Error: nothing is felt. Warning: something is not felt. Info: a remark.</param>
    /// <param name="About">The objects with the problem; null when it concerns the project.</param>
    internal sealed record Finding(
        MessageType Severity, string Text, IReadOnlyList<Object>? About = null, params Repair[] Repairs)
    {
        /// <summary>The objects with the problem; empty when it concerns the project.</summary>
        public IReadOnlyList<Object> Objects => About ?? Array.Empty<Object>();
    }
}
