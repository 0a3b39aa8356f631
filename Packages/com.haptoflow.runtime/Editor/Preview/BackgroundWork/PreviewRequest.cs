#nullable enable
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>The input of a preview. Immutable by convention once submitted.</summary>
    /// <param name="ModelFile">Bytes of a whole .haptoflow file. Models are compared by reference.</param>
    /// <param name="Stroke">Strokes are compared by reference.</param>
    /// <param name="Materials">One, or two to compare.</param>
    internal sealed record PreviewRequest(byte[] ModelFile, Stroke Stroke, IReadOnlyList<LabelMix> Materials)
    {
        /// <summary>The model's sliders; null if it has none.</summary>
        public SliderSet? Sliders { get; set; }

        /// <summary>Index of the sound that is played.</summary>
        public int Active { get; set; }

        /// <summary>Name of a tier of the model, one of <see cref="PreviewQualities.Tiers"/>.</summary>
        public string Tier { get; set; } = "standard";

        /// <summary>Effects of the surface.</summary>
        public HapticEffects Effects { get; set; } = HapticEffects.Texture;

        /// <summary>If this is not an actuator, its sound is shown beside the first material's.</summary>
        public PreviewDevice Device { get; set; }

        /// <summary>Key of the noise generator.</summary>
        public ulong Seed { get; set; } = 1;

        /// <summary>True while a control is dragged: a used engine may render, whose noise differs from a fresh one's.
        /// </summary>
        public bool IsSketch { get; set; }

        /// <summary>The tiers are timed when this number differs from that of the last timing; 0 for never.</summary>
        public int Measurement { get; set; }
    }

    /// <summary>The output of a preview. Immutable by convention.</summary>
    /// <param name="Sounds">As many as the request has materials, and one more if a device renders the first; none if
    /// there is a problem.</param>
    /// <param name="Qualities">One for each tier; none if the model cannot be read.</param>
    /// <param name="Problem">Why there is no sound; null if there is one.</param>
    internal sealed record PreviewResult(PreviewRequest Request, IReadOnlyList<AnalysedSound> Sounds,
        IReadOnlyList<QualityRow> Qualities, string? Problem)
    {
        /// <summary>Draws the sounds.</summary>
        public SoundPanel Panel { get; } = new SoundPanel(Sounds);
    }
}
