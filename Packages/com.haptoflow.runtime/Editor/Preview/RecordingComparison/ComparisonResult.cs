#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>What a comparison shows. Immutable by custom.</summary>
    internal sealed class ComparisonResult
    {
        public ComparisonResult(PixelCanvas charts, IReadOnlyList<AnalysedSound> sounds, string? problem)
        {
            Charts = charts;
            Sounds = sounds;
            Problem = problem;
        }

        public PixelCanvas Charts { get; }

        /// <summary>The recording, and behind it the result where there is one.</summary>
        public IReadOnlyList<AnalysedSound> Sounds { get; }

        /// <summary>Why the result does not sound; null where it does, or where there is none yet.</summary>
        public string? Problem { get; }
    }
}
