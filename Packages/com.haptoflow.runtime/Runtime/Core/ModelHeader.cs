#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Native;

namespace HaptoFlow.Model
{
    /// <summary>Provenance of a model.</summary>
    public sealed class ModelProvenance
    {
        internal ModelProvenance(in ModelInfo info)
        {
            Statement = NativeCall.Text(info.Statement);
            Recordings = NativeCall.Text(info.Recordings);
            Licence = NativeCall.Text(info.Licence);
            Commit = NativeCall.Text(info.Commit);
            Created = NativeCall.Text(info.Created);
        }

        /// <summary>One sentence, for example "trained on synthetic recordings".</summary>
        public string Statement { get; }

        /// <summary>The recordings that the model was trained on.</summary>
        public string Recordings { get; }

        /// <summary>Licence of the recordings.</summary>
        public string Licence { get; }

        /// <summary>Commit of the training code.</summary>
        public string Commit { get; }

        /// <summary>Date as YYYY-MM-DD, or empty.</summary>
        public string Created { get; }
    }

    /// <summary>The interval of the speeds or forces that a model was trained on, or a material learnt from.</summary>
    public readonly struct TrainedInterval
    {
        internal TrainedInterval(double minimum, double maximum) => (Minimum, Maximum) = (minimum, maximum);

        /// <summary>Lower limit, in the unit of the property that holds the interval.</summary>
        public double Minimum { get; }

        /// <summary>Upper limit, in the unit of the property that holds the interval.</summary>
        public double Maximum { get; }
    }

    /// <summary>The header of a .haptoflow file as the native library reads it, which also verifies the rest of the
    /// file. Immutable; any thread.</summary>
    public sealed unsafe class ModelHeader
    {
        internal ModelHeader(
            in ModelInfo info, string space, IReadOnlyList<HapticLabel> labels, IReadOnlyList<HapticTier> tiers)
        {
            Name = NativeCall.Text(info.Name);
            Description = NativeCall.Text(info.Description);
            Provenance = new ModelProvenance(info);
            SpeedMps = new TrainedInterval(info.SpeedMps[0], info.SpeedMps[1]);
            ForceNewtons = new TrainedInterval(info.ForceNewtons[0], info.ForceNewtons[1]);
            Space = space;
            Labels = labels;
            Tiers = tiers;
        }

        /// <summary>Name for display.</summary>
        public string Name { get; }

        /// <summary>One or two sentences.</summary>
        public string Description { get; }

        /// <summary>Provenance of the model.</summary>
        public ModelProvenance Provenance { get; }

        /// <summary>Speeds that the network was trained on, in m/s.</summary>
        public TrainedInterval SpeedMps { get; }

        /// <summary>Forces that the network was trained on, in N.</summary>
        public TrainedInterval ForceNewtons { get; }

        /// <summary>Identifies the space of the embeddings: see <see cref="HapticModel.Space"/>.</summary>
        public string Space { get; }

        /// <summary>The labels in the order of their indices.</summary>
        public IReadOnlyList<HapticLabel> Labels { get; }

        /// <summary>The tiers in order of increasing accuracy.</summary>
        public IReadOnlyList<HapticTier> Tiers { get; }

        /// <summary>The tier that is used unless another is selected.</summary>
        public HapticTier DefaultTier => Tiers.Single(tier => tier.IsDefault);

        /// <summary>The tier that an engine of this quality plays, as haptoflow.h says it (haptoflow_quality).</summary>
        internal HapticTier TierOf(HapticQuality quality) => quality switch
        {
            HapticQuality.Sketch => Named("sketch") ?? Tiers[0],
            HapticQuality.Draft => Named("draft") ?? Tiers[0],
            _ => Named("standard") ?? DefaultTier,
        };

        private HapticTier? Named(string name) => Tiers.FirstOrDefault(tier => tier.Name == name);

        /// <param name="file">The whole .haptoflow file; the array is not kept.</param>
        /// <exception cref="HaptoFlowException">The library is missing, or the bytes are not a usable model; the
        /// message says why.</exception>
        public static ModelHeader Read(byte[] file)
        {
            using HapticModel model = HapticModel.Open(file);
            return model.Header;
        }
    }
}
