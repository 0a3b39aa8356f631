#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;
using HaptoFlow.Preview;

namespace HaptoFlow.Editor
{
    /// <summary>Labels and tiers of a model. Main thread.</summary>
    internal sealed class PreviewModel
    {
        private PreviewModel(byte[] file, ModelHeader? header, string? problem)
        {
            File = file;
            Problem = problem;
            Labels = header?.Labels.Select(label => label.Name).ToArray() ?? Array.Empty<string>();
            Tiers = header == null ? Array.Empty<string>() : PreviewQualities.Tiers(header);
            DefaultTier = header?.DefaultTier.Name ?? "standard";
        }

        /// <summary>Empty without a model.</summary>
        public byte[] File { get; }

        /// <summary>In the model's order; empty if it cannot be read.</summary>
        public IReadOnlyList<string> Labels { get; }

        /// <summary>Names of the tiers that an engine plays at one of its fixed qualities.</summary>
        public IReadOnlyList<string> Tiers { get; }

        public string DefaultTier { get; }

        /// <summary>The name itself if the model has such a tier, else its default. A window's state may name a tier of
        /// another model.</summary>
        public string TierOrDefault(string name) => Tiers.Contains(name) ? name : DefaultTier;

        /// <summary>Why the model cannot be previewed; null if it can.</summary>
        public string? Problem { get; }

        public static PreviewModel Of(HapticModelAsset? asset)
        {
            if (asset == null)
            {
                return new PreviewModel(Array.Empty<byte>(), null,
                    "There is no model to preview. Choose one above or in Project Settings > HaptoFlow, or reinstall " +
                    "the package, which contains one.");
            }
            try
            {
                return new PreviewModel(asset.File, asset.Header, null);
            }
            catch (HaptoFlowException error)
            {
                return new PreviewModel(
                    asset.File, null, $"The model {asset.name} cannot be used: {error.Message}.");
            }
        }
    }
}
