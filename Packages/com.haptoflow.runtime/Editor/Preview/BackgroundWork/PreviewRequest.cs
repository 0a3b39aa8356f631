#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>What a preview shall show. Immutable by custom.</summary>
    internal sealed class PreviewRequest
    {
        public PreviewRequest(byte[] modelFile, Stroke stroke, IReadOnlyList<LabelMix> materials)
        {
            ModelFile = modelFile;
            Stroke = stroke;
            Materials = materials;
        }

        /// <summary>Bytes of a whole .haptoflow file; another array is another model.</summary>
        public byte[] ModelFile { get; }

        /// <summary>Another object is another stroke.</summary>
        public Stroke Stroke { get; }

        /// <summary>One, or two to compare.</summary>
        public IReadOnlyList<LabelMix> Materials { get; }

        /// <summary>Of the model's space; null where it has none.</summary>
        public SliderSet? Sliders { get; set; }

        /// <summary>Which of them is heard.</summary>
        public int Active { get; set; }

        /// <summary>Name of a tier of the model: "draft", "standard" or "fine".</summary>
        public string Tier { get; set; } = "standard";

        /// <summary>What the surface asks for.</summary>
        public HapticEffects Effects { get; set; } = HapticEffects.Texture;

        /// <summary>What the wave is felt through: anything but an actuator is shown beside the active material's wave.
        /// </summary>
        public PreviewDevice Device { get; set; }

        /// <summary>Key of all noise.</summary>
        public ulong Seed { get; set; } = 1;

        /// <summary>A control is held down: be quick, other noise will do.</summary>
        public bool IsSketch { get; set; }

        /// <summary>Milliseconds are measured where this number was not seen before; 0 for never.</summary>
        public int Measurement { get; set; }
    }

    /// <summary>What a preview shows. Immutable by convention.</summary>
    internal sealed class PreviewResult
    {
        public PreviewResult(PreviewRequest request, IReadOnlyList<AnalysedSound> sounds)
        {
            Request = request;
            Sounds = sounds;
            Panel = new SoundPanel(sounds);
        }

        public PreviewRequest Request { get; }

        /// <summary>As many as the request has materials, and one more if a device renders the first; none if there is a
        /// problem.</summary>
        public IReadOnlyList<AnalysedSound> Sounds { get; }

        /// <summary>Draws the sounds.</summary>
        public SoundPanel Panel { get; }

        /// <summary>One for each tier; none if the model cannot be read.</summary>
        public IReadOnlyList<QualityRow> Qualities { get; set; } = Array.Empty<QualityRow>();

        /// <summary>Why there is no sound; null if there is one.</summary>
        public string? Problem { get; set; }
    }
}
