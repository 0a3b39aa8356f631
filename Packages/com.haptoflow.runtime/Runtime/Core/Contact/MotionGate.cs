#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>Detects from frame to frame whether a tip moves over a surface, for signals that start and stop
    /// with the motion: by the last two measurements alone, whatever came before.</summary>
    /// <remarks>Two thresholds keep a tracker's noise and a hand's tremor (some 10 mm/s) from switching a signal at
    /// rest. The difference of two frames lags by half a frame, which is counted as part of the pose
    /// interval.</remarks>
    internal sealed class MotionGate
    {
        /// <summary>Speed at which a tip at rest starts to move.</summary>
        public const double StartSpeedMps = 0.03;

        /// <summary>Speed below which a moving tip comes to rest.</summary>
        public const double StopSpeedMps = 0.015;

        // A tracker slower than the frame rate repeats positions.
        private const double MaximumRepeatSeconds = 0.03;
        private const double MinimumMoveMetres = 1e-7;
        private const double MinimumStepSeconds = 0.0005;

        private bool hasPlace;
        private double measuredSeconds;
        private Double3 measuredMetres;

        /// <summary>True while the tip moves.</summary>
        public bool Moves { get; private set; }

        /// <summary>Speed between the last two measurements.</summary>
        public double SpeedMps { get; private set; }

        /// <summary>Processes one frame.</summary>
        /// <param name="pointMetres">Contact point, in the surface's frame or, over a surface at rest, in the
        /// world.</param>
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
            bool isRepeat = moved < MinimumMoveMetres && passed < MaximumRepeatSeconds;
            if (passed >= MinimumStepSeconds && !isRepeat)
            {
                Measure(nowSeconds, pointMetres);
                SpeedMps = moved / passed;
                Moves = SpeedMps >= (Moves ? StopSpeedMps : StartSpeedMps);
            }
            return Moves;
        }

        /// <summary>The tip has slid to another surface, where its point has other coordinates.</summary>
        public void Continue(double nowSeconds, in Double3 pointMetres) => Measure(nowSeconds, pointMetres);

        private void Measure(double nowSeconds, in Double3 pointMetres)
        {
            hasPlace = true;
            measuredSeconds = nowSeconds;
            measuredMetres = pointMetres;
        }
    }
}
