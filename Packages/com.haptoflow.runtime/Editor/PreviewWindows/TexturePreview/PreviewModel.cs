#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Editor
{
    /// <summary>What the window knows of a model without the native library. Main thread.</summary>
    internal sealed class PreviewModel
    {
        private static readonly string[] Playable = { "draft", "standard", "fine" };

        private PreviewModel(byte[] file, ModelHeader? header, string? problem)
        {
            File = file;
            Problem = problem;
            Labels = header?.Labels.Select(label => label.Name).ToArray() ?? Array.Empty<string>();
            Tiers = header?.Tiers.Select(tier => tier.Name).Where(name => Playable.Contains(name)).ToArray() ??
                Array.Empty<string>();
            DefaultTier = header?.DefaultTier.Name ?? "standard";
        }

        /// <summary>Empty where there is no model.</summary>
        public byte[] File { get; }

        /// <summary>In the model's order; empty where it cannot be read.</summary>
        public IReadOnlyList<string> Labels { get; }

        /// <summary>Tiers that an engine can play.</summary>
        public IReadOnlyList<string> Tiers { get; }

        public string DefaultTier { get; }

        /// <summary>The tier of that name, or the model's default where it has none: a window may have been saved with
        /// another model.</summary>
        public string TierOrDefault(string name) => Tiers.Contains(name) ? name : DefaultTier;

        /// <summary>Why there is nothing to preview; null where there is.</summary>
        public string? Problem { get; }

        public static PreviewModel Of(HapticModelAsset? asset)
        {
            if (asset == null)
            {
                return new PreviewModel(Array.Empty<byte>(), null,
                    "There is no model to preview. Choose one above or in Project Settings > HaptoFlow, or install " +
                    "the package again: it brings one.");
            }
            try
            {
                return new PreviewModel(asset.File, ModelHeader.Read(asset.File), null);
            }
            catch (HaptoFlowException error)
            {
                return new PreviewModel(
                    asset.File, null, $"The model {asset.name} cannot be used: {error.Message}.");
            }
        }
    }
}
