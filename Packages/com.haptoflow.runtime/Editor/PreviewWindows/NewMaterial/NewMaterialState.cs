#nullable enable
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The settings of the New Material window, with undo. Also holds the learnt material, which thus survives
    /// domain reloads and errors.</summary>
    internal sealed class NewMaterialState : PreviewState<NewMaterialState>
    {
        public const float MaximumSpeedMps = 10f;
        public const float MaximumForceNewtons = 100f;

        /// <summary>Path of the recording's file; empty until one is chosen.</summary>
        [field: SerializeField]
        public string Path { get; set; } = "";

        /// <summary>Used if the recording has no speed; 0 for unknown.</summary>
        [field: SerializeField]
        public float SpeedMps { get; set; }

        /// <summary>Used if the recording has no force; 0 for unknown.</summary>
        [field: SerializeField]
        public float ForceNewtons { get; set; }

        /// <summary>Acceleration of a sample of 1 in a WAV file without sidecar; 0 for unknown.</summary>
        [field: SerializeField]
        public float FullScaleMps2 { get; set; }

        [field: SerializeField]
        public string Name { get; set; } = "";

        [field: SerializeField]
        public string Category { get; set; } = "";

        /// <summary>Licence of the recording; empty for unknown.</summary>
        [field: SerializeField]
        public string Licence { get; set; } = "";

        [field: SerializeField]
        public string Description { get; set; } = "";

        /// <summary>The text of the learnt material's file; empty before one was learnt.</summary>
        [field: SerializeField]
        public string Material { get; set; } = "";

        /// <summary>The library's report on learning, as JSON; empty before a material was learnt.</summary>
        [field: SerializeField]
        public string Report { get; set; } = "";

        /// <summary>True to show and play the result at the recording's level.</summary>
        [field: SerializeField]
        public bool MatchesLevels { get; set; }

        /// <summary>Index of the sound that is played: 0 for the recording, 1 for the result.</summary>
        [field: SerializeField]
        public int Active { get; set; } = 1;

        /// <summary>True to show the curves of recording and result, false for their sounds.</summary>
        [field: SerializeField]
        public bool ShowsCurves { get; set; }

        protected override string WindowName => "New Material";
    }
}
