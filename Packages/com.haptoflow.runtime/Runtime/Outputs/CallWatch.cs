#nullable enable
namespace HaptoFlow
{
    /// <summary>Notices that the audio engine no longer calls an output. Main thread.</summary>
    internal struct CallWatch
    {
        private ulong knownCalls;
        private FrameTime silence;
        private bool hasTold;

        public void Restart() => this = default;

        /// <summary>True once for each silence, after a second of frames without a call.</summary>
        /// <param name="calls">A count that changes with each call.</param>
        /// <param name="areExpected">False while there may be none.</param>
        public bool Misses(ulong calls, bool areExpected)
        {
            if (calls != knownCalls)
            {
                Restart();
            }
            knownCalls = calls;
            if (!areExpected)
            {
                silence.Restart();
                return false;
            }
            bool tells = silence.Add() && !hasTold;
            hasTold |= tells;
            return tells;
        }
    }
}
