#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Whether an output is paused: while the application is, and while AudioListener.pause is set, unless the
    /// output plays while paused. Main thread.</summary>
    internal struct OutputPause
    {
        private bool application;

        public bool IsPaused { get; private set; }

        /// <summary>True where the application's pause began or ended the output's.</summary>
        public bool PauseApplication(bool paused, bool playsWhilePaused)
        {
            application = paused;
            return Update(playsWhilePaused);
        }

        /// <summary>Reads AudioListener.pause, which Unity does not report; true where the output's pause began or
        /// ended.</summary>
        public bool Update(bool playsWhilePaused)
        {
            bool before = IsPaused;
            IsPaused = application || (AudioListener.pause && !playsWhilePaused);
            return IsPaused != before;
        }
    }
}
