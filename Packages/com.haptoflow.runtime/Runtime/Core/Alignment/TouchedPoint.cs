#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Alignment
{
    /// <summary>Detects the place where a pen rests: pressed and still for a while. Averaging over that time is more
    /// accurate than one tracked position. One thread at a time; no garbage.</summary>
    internal sealed class TouchedPoint
    {
        public const double StillSeconds = 0.3;

        /// <summary>A tip farther than this from where it came to rest has moved.</summary>
        public const double StillMetres = 0.003;

        private const int MinimumSamples = 5;

        private Double3 anchor;
        private Double3 sum;
        private int count;
        private double beganSeconds;
        private bool taken;

        /// <summary>True once per rest: the tip must lift before the next.</summary>
        /// <param name="place">Mean position of the tip's centre, in metres.</param>
        public bool Update(double timeSeconds, Double3 tipMetres, bool pressed, out Double3 place)
        {
            place = tipMetres;
            if (!pressed || !Vectors.IsUsable(timeSeconds) || !Vectors.IsUsable(tipMetres))
            {
                count = 0;
                taken = taken && pressed;
                return false;
            }
            if (taken)
            {
                return false;
            }
            if (count == 0 || timeSeconds < beganSeconds || Double3.Distance(tipMetres, anchor) > StillMetres)
            {
                anchor = tipMetres;
                sum = Double3.Zero;
                count = 0;
                beganSeconds = timeSeconds;
            }
            sum += tipMetres;
            ++count;
            if (count < MinimumSamples || timeSeconds - beganSeconds < StillSeconds)
            {
                return false;
            }
            taken = true;
            place = sum / count;
            return true;
        }

        /// <summary>Ignores the present rest: the pen must lift first.</summary>
        public void AwaitLift()
        {
            count = 0;
            taken = true;
        }
    }
}
