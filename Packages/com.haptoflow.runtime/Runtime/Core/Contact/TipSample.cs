#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>A sample of the stylus tip.</summary>
    internal readonly struct TipSample
    {
        /// <summary>Time on any monotonic clock.</summary>
        public readonly double TimeSeconds;

        /// <summary>Centre of the tip sphere.</summary>
        public readonly Double3 PositionMetres;

        /// <summary>Measured tip force, which replaces the spring force; null without one.</summary>
        public readonly double? ForceNewtons;

        public TipSample(double timeSeconds, Double3 positionMetres, double? forceNewtons = null) =>
            (TimeSeconds, PositionMetres, ForceNewtons) = (timeSeconds, positionMetres, forceNewtons);
    }
}
