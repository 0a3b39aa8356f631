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
    internal sealed class ComparisonResult
    {
        public ComparisonResult(ComparisonRequest request, IReadOnlyList<AnalysedSound> sounds, string? problem)
        {
            Request = request;
            Sounds = sounds;
            Panel = new SoundPanel(sounds);
            Problem = problem;
        }

        public ComparisonRequest Request { get; }

        /// <summary>The recording, and after it the result if there is one.</summary>
        public IReadOnlyList<AnalysedSound> Sounds { get; }

        /// <summary>Draws the sounds.</summary>
        public SoundPanel Panel { get; }

        /// <summary>Index of the sound that is played.</summary>
        public int Active => Math.Min(Request.Active, Sounds.Count - 1);

        /// <summary>Why the result cannot be rendered; null if it can, or if there is none yet.</summary>
        public string? Problem { get; }
    }
}
