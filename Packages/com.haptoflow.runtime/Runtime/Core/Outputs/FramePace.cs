#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>How far ahead of a device the main thread has to be: the longest of the recent frames and a margin. A
    /// hitch does not count, so the depth, which is latency, has an end.</summary>
    internal sealed class FramePace
    {
        /// <summary>A frame longer than this is a hitch, in s.</summary>
        public const double HitchSeconds = 0.05;

        private const double MarginSeconds = 0.006;
        private const double ShareForgottenPerFrame = 0.02;

        private double longestSeconds = 1.0 / 72.0;

        /// <summary>What must be ahead of the device after a submission, in s.</summary>
        public double DepthSeconds => longestSeconds + MarginSeconds;

        /// <summary>The most that <see cref="DepthSeconds"/> can become.</summary>
        public static double MaximumDepthSeconds => HitchSeconds + MarginSeconds;

        /// <summary>The longest of the recent frames, in s.</summary>
        public double LongestSeconds => longestSeconds;

        public void Note(double frameSeconds)
        {
            if (frameSeconds > HitchSeconds || !(frameSeconds > 0.0))
            {
                return;
            }
            longestSeconds = Math.Max(frameSeconds,
                longestSeconds + ShareForgottenPerFrame * (frameSeconds - longestSeconds));
        }
    }
}
