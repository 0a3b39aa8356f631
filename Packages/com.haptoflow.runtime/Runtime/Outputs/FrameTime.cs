#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A second of running frames, in which the audio thread has time for several blocks. A frame counts as 0.1 s at
    /// most: after a hitch or a suspended application the audio thread is given its time again. Main thread.</summary>
    internal struct FrameTime
    {
        private const double PatienceSeconds = 1.0;
        private const double LongestFrameSeconds = 0.1;
        private double seconds;

        public void Restart() => seconds = 0.0;

        /// <summary>Adds this frame; true where the second is over, which begins again.</summary>
        public bool Add()
        {
            seconds += Math.Min(Time.unscaledDeltaTime, LongestFrameSeconds);
            bool isOver = seconds >= PatienceSeconds;
            seconds = isOver ? 0.0 : seconds;
            return isOver;
        }
    }
}
