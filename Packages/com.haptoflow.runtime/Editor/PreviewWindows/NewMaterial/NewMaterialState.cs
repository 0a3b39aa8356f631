#nullable enable
using System;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Everything that can be set in the window that learns materials, undoable; what was learnt is kept here
    /// too, so that neither a reload of the scripts nor an error loses it.</summary>
    internal sealed class NewMaterialState : ScriptableObject
    {
        public const float MaximumSpeedMps = 10f;
        public const float MaximumForceNewtons = 100f;

        /// <summary>Null for the project's.</summary>
        [field: SerializeField]
        public HapticModelAsset? Model { get; set; }

        /// <summary>Of the recording's file; empty until one is chosen.</summary>
        [field: SerializeField]
        public string Path { get; set; } = "";

        /// <summary>In m/s, where the recording does not say; 0 for unknown.</summary>
        [field: SerializeField]
        public float SpeedMps { get; set; }

        /// <summary>In N, where the recording does not say; 0 for unknown.</summary>
        [field: SerializeField]
        public float ForceNewtons { get; set; }

        /// <summary>Of a WAV file without sidecar: the acceleration of +-1; 0 for unknown.</summary>
        [field: SerializeField]
        public float FullScaleMps2 { get; set; }

        [field: SerializeField]
        public string Name { get; set; } = "";

        [field: SerializeField]
        public string Category { get; set; } = "";

        /// <summary>Of the recording; empty where nobody knows.</summary>
        [field: SerializeField]
        public string Licence { get; set; } = "";

        [field: SerializeField]
        public string Description { get; set; } = "";

        /// <summary>The text of the material that was learnt; empty for none yet.</summary>
        [field: SerializeField]
        public string Material { get; set; } = "";

        /// <summary>What the fit achieved, as JSON; empty for none yet.</summary>
        [field: SerializeField]
        public string Report { get; set; } = "";

        /// <summary>The result is shown and played at the recording's level.</summary>
        [field: SerializeField]
        public bool MatchesLevels { get; set; }

        /// <summary>Which is heard: 0 for the recording, 1 for the result.</summary>
        [field: SerializeField]
        public int Active { get; set; } = 1;

        [field: SerializeField]
        public bool Loops { get; set; }

        /// <summary>Another number whenever something may be different.</summary>
        public int Version { get; private set; }

        /// <summary>Makes a change that can be undone.</summary>
        /// <param name="what">Of the undo's name, for example "Speed".</param>
        public void Change(string what, Action<NewMaterialState> change)
        {
            Undo.RecordObject(this, "New Material " + what);
            change(this);
            ++Version;
        }

        /// <summary>Something was undone or done again.</summary>
        public void MarkChanged() => ++Version;
    }
}
