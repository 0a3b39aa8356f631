#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Recordings;

namespace HaptoFlow.Preview
{
    /// <summary>A recording and the material learnt from it, to be compared. Immutable once submitted.</summary>
    /// <param name="ModelFile">Bytes of a whole .haptoflow file. Models are compared by reference.</param>
    /// <param name="Recording">Recordings are compared by reference.</param>
    internal sealed record ComparisonRequest(byte[] ModelFile, Recording Recording)
    {
        /// <summary>The text of the learnt material's file; empty before one was learnt.</summary>
        public string Material { get; set; } = "";

        /// <summary>Angle from the recording's first axis to the material's, perpendicular to its ribs.</summary>
        public double TurnDegrees { get; set; }

        /// <summary>True to play the result at the recording's level.</summary>
        public bool MatchesLevels { get; set; }

        /// <summary>Index of the sound that is played: 0 for the recording, 1 for the result.</summary>
        public int Active { get; set; }
    }

    /// <summary>The output of a comparison. Immutable by convention.</summary>
    /// <param name="Sounds">The recording, and after it the result if there is one.</param>
    /// <param name="Problem">Why the result cannot be rendered; null if it can, or if there is none yet.</param>
    internal sealed record ComparisonResult(
        ComparisonRequest Request, IReadOnlyList<AnalysedSound> Sounds, string? Problem)
    {
        /// <summary>Draws the sounds.</summary>
        public SoundPanel Panel { get; } = new SoundPanel(Sounds);

        /// <summary>Index of the sound that is played.</summary>
        public int Active => Math.Min(Request.Active, Sounds.Count - 1);
    }
}
