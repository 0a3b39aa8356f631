#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>Where the stylus says its tip is.</summary>
    internal readonly struct TipSample
    {
        /// <summary>On any clock that does not run backwards.</summary>
        public readonly double TimeSeconds;

        /// <summary>Centre of the tip sphere.</summary>
        public readonly Double3 PositionMetres;

        /// <summary>The stylus's own tip force, which takes the place of the spring; null where it has none.</summary>
        public readonly double? ForceNewtons;

        public TipSample(double timeSeconds, Double3 positionMetres, double? forceNewtons = null)
        {
            TimeSeconds = timeSeconds;
            PositionMetres = positionMetres;
            ForceNewtons = forceNewtons;
        }
    }
}
