#nullable enable
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

        public Palette Palette { get; set; } = Palette.Dark;

        public Box Charts { get; set; }

        /// <summary>Pixels of a point.</summary>
        public double PixelsPerPoint { get; set; } = 1.0;
    }
}
