#nullable enable
using System;
using System.Collections.Generic;
using UnityEditor;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Something to do about a finding.</summary>
    internal sealed class Repair
    {
        public Repair(string caption, Action act)
        {
            Caption = caption;
            Act = act;
        }

        /// <summary>On its button.</summary>
        public string Caption { get; }

        public Action Act { get; }
    }

    /// <summary>Something in the scene or the project that keeps things from being felt, or from being felt well.
    /// </summary>
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

        /// <summary>Error: nothing is felt. Warning: something is not. Info: worth knowing.</summary>
        public MessageType Severity { get; }

        public string Text { get; }

        /// <summary>What it is about; empty for the project.</summary>
        public IReadOnlyList<Object> Objects { get; }

        public IReadOnlyList<Repair> Repairs { get; }
    }
}
