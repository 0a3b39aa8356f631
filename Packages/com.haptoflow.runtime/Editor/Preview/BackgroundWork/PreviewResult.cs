#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>What a preview shows. Immutable by custom.</summary>
    internal sealed class PreviewResult
    {
        public PreviewResult(PreviewRequest request, PixelCanvas strokePanel, PixelCanvas charts)
        {
            Request = request;
            StrokePanel = strokePanel;
            Charts = charts;
        }

        public PreviewRequest Request { get; }

        public PixelCanvas StrokePanel { get; }

        public PixelCanvas Charts { get; }

        /// <summary>As many as the request has materials; none where there is a problem.</summary>
        public IReadOnlyList<AnalysedSound> Sounds { get; set; } = Array.Empty<AnalysedSound>();

        /// <summary>One for each tier; none where the model cannot be read.</summary>
        public IReadOnlyList<QualityRow> Qualities { get; set; } = Array.Empty<QualityRow>();

        /// <summary>Why nothing sounds; null where something does.</summary>
        public string? Problem { get; set; }
    }
}
