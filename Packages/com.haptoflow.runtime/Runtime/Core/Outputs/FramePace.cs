#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>Computes how far the main thread must be ahead of a device: the longest of the recent frames plus a
    /// margin. Hitches are ignored, so that the latency stays bounded.</summary>
    internal sealed class FramePace
    {
        /// <summary>A longer frame is a hitch, in s.</summary>
        public const double HitchSeconds = 0.05;

        private const double MarginSeconds = 0.006;
        private const double DecayPerFrame = 0.02;

        /// <summary>Time that must be queued on the device after a submission, in s.</summary>
        public double DepthSeconds => MaximumSeconds + MarginSeconds;

        /// <summary>Upper limit of <see cref="DepthSeconds"/>, in s.</summary>
        public static double MaximumDepthSeconds => HitchSeconds + MarginSeconds;

        /// <summary>The longest of the recent frames, in s.</summary>
        public double MaximumSeconds { get; private set; } = 1.0 / HapticEngineOptions.DefaultUpdateRateHz;

        public void Note(double frameSeconds)
        {
            if (frameSeconds > HitchSeconds || !(frameSeconds > 0.0))
            {
                return;
            }
            MaximumSeconds = Math.Max(frameSeconds,
                MaximumSeconds + DecayPerFrame * (frameSeconds - MaximumSeconds));
        }
    }
}
