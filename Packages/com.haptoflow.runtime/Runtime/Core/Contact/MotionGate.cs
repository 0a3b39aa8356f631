#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>Says whether a tip moves over a surface that stands still, from one frame to the next: for signals
    /// that must begin and end with the motion. The velocity that textures are made from looks back over 35 ms and
    /// would come later.</summary>
    /// <remarks>Two thresholds keep the noise of a tracker and a hand's tremor (some 10 mm/s) from switching a signal
    /// on and off at rest. A difference of two frames lags by half a frame, which counts as part of the time between
    /// two poses.</remarks>
    internal sealed class MotionGate
    {
        /// <summary>A tip at rest sets off at this speed.</summary>
        public const double SetsOffMps = 0.03;

        /// <summary>A moving tip comes to rest below this speed.</summary>
        public const double RestsMps = 0.015;

        // A tracker slower than the frame rate repeats positions.
        private const double MaximumRepeatSeconds = 0.03;
        private const double SmallestMoveMetres = 1e-7;
        private const double ShortestStepSeconds = 0.0005;

        private bool hasPlace;
        private double measuredSeconds;
        private Double3 measuredMetres;

        /// <summary>The tip moves.</summary>
        public bool Moves { get; private set; }

        /// <summary>Of the last two measurements.</summary>
        public double SpeedMps { get; private set; }

        /// <summary>One more frame.</summary>
        /// <param name="pointMetres">Where the tip touches, in world space.</param>
        /// <returns><see cref="Moves"/>.</returns>
        public bool Update(double nowSeconds, bool touching, in Double3 pointMetres)
        {
            if (!touching)
            {
                hasPlace = false;
                Moves = false;
                SpeedMps = 0.0;
                return false;
            }
            double passed = nowSeconds - measuredSeconds;
            if (!hasPlace || passed < 0.0)
            {
                Measure(nowSeconds, pointMetres);
                return Moves;
            }
            double moved = Double3.Distance(pointMetres, measuredMetres);
            bool isRepeat = moved < SmallestMoveMetres && passed < MaximumRepeatSeconds;
            if (passed >= ShortestStepSeconds && !isRepeat)
            {
                Measure(nowSeconds, pointMetres);
                SpeedMps = moved / passed;
                Moves = SpeedMps >= (Moves ? RestsMps : SetsOffMps);
            }
            return Moves;
        }

        private void Measure(double nowSeconds, in Double3 pointMetres)
        {
            hasPlace = true;
            measuredSeconds = nowSeconds;
            measuredMetres = pointMetres;
        }
    }
}
