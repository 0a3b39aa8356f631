#nullable enable
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
    /// <summary>The tiers of a model that can be previewed, and the quality that plays each.</summary>
    internal static class PreviewQualities
    {
        private static readonly HapticQuality[] Fixed =
        {
            HapticQuality.Sketch, HapticQuality.Draft, HapticQuality.Standard,
        };

        /// <summary>Their names, in the order of the model.</summary>
        public static string[] Tiers(ModelHeader header) => header.Tiers
            .Where(tier => Fixed.Any(quality => header.TierOf(quality).Name == tier.Name))
            .Select(tier => tier.Name).ToArray();

        /// <exception cref="HaptoFlowException">No quality plays this tier.</exception>
        public static HapticQuality Of(ModelHeader header, string tier)
        {
            foreach (HapticQuality quality in Fixed)
            {
                if (header.TierOf(quality).Name == tier)
                {
                    return quality;
                }
            }
            throw new HaptoFlowException(HaptoFlowStatus.InvalidArgument,
                $"tier \"{tier}\" cannot be previewed; expected {string.Join(", ", Tiers(header))}");
        }
    }
}
