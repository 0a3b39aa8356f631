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
        public string Path = "";

        /// <summary>Used if the recording has no speed; 0 for unknown.</summary>
        public float SpeedMps;

        /// <summary>Used if the recording has no force; 0 for unknown.</summary>
        public float ForceNewtons;

        /// <summary>Acceleration of a sample of 1 in a WAV file without sidecar; 0 for unknown.</summary>
        public float FullScaleMps2;
        public string Name = "";
        public string Category = "";

        /// <summary>Licence of the recording; empty for unknown.</summary>
        public string Licence = "";
        public string Description = "";

        /// <summary>The text of the learnt material's file; empty before one was learnt.</summary>
        public string Material = "";

        /// <summary>The library's report on learning, as JSON; empty before a material was learnt.</summary>
        public string Report = "";

        /// <summary>True to show and play the result at the recording's level.</summary>
        public bool MatchesLevels;

        /// <summary>Index of the sound that is played: 0 for the recording, 1 for the result.</summary>
        public int Active = 1;

        /// <summary>True to show the curves of recording and result, false for their sounds.</summary>
        public bool ShowsCurves;

        protected override string WindowName => "New Material";
    }
}
