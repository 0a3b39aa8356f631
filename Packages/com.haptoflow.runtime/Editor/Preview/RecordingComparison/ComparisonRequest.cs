#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Recordings;

namespace HaptoFlow.Preview
{
    /// <summary>A recording, and beside it what was learnt from it. Immutable by custom.</summary>
    internal sealed class ComparisonRequest
    {
        public ComparisonRequest(byte[] modelFile, Recording recording)
        {
            ModelFile = modelFile;
            Recording = recording;
        }

        /// <summary>Bytes of a whole .haptoflow file; another array is another model.</summary>
        public byte[] ModelFile { get; }

        /// <summary>Another object is another recording.</summary>
        public Recording Recording { get; }

        /// <summary>The text of the material that was learnt; empty for none yet.</summary>
        public string Material { get; set; } = "";

        /// <summary>From the recording's first axis to the material's, which lies across its ribs.</summary>
        public double TurnDegrees { get; set; }

        /// <summary>The result is raised or lowered to the recording's level.</summary>
        public bool MatchesLevels { get; set; }

        /// <summary>Which is heard: 0 for the recording, 1 for the result.</summary>
        public int Active { get; set; }
    }

    /// <summary>What a comparison shows. Immutable by convention.</summary>
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
