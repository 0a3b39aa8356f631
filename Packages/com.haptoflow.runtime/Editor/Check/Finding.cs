#nullable enable
using System;
using System.Collections.Generic;
using UnityEditor;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>A remedy for a finding.</summary>
    internal sealed class Repair
    {
        public Repair(string caption, Action act)
        {
            Caption = caption;
            Act = act;
        }

        /// <summary>The text of its button.</summary>
        public string Caption { get; }

        public Action Act { get; }
    }

    /// <summary>A problem of the scene or the project that prevents or degrades haptics.</summary>
    internal sealed class Finding
    {
        public Finding(
            MessageType severity, string text, IReadOnlyList<Object>? objects = null, params Repair[] repairs)
        {
            Severity = severity;
            Text = text;
            Objects = objects ?? Array.Empty<Object>();
            Repairs = repairs;
        }

        /// <summary>Error: nothing is felt. Warning: something is not felt. Info: a remark.</summary>
        public MessageType Severity { get; }

        public string Text { get; }

        /// <summary>The objects with the problem; empty when it concerns the project.</summary>
        public IReadOnlyList<Object> Objects { get; }

        public IReadOnlyList<Repair> Repairs { get; }
    }
}
