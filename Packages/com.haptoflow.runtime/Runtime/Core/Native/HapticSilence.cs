#nullable enable

namespace HaptoFlow
{
    /// <summary>Why a voice is silent. Where several reasons apply, the one that lasts longest.</summary>
    public enum HapticSilence
    {
        /// <summary>The voice sounds.</summary>
        None = 0,

        /// <summary>Nothing is touched, or the tip does not slide.</summary>
        Rest = 1,

        /// <summary>No contact state was published for 100 ms.</summary>
        Stale = 2,

        /// <summary>The output is muted.</summary>
        Muted = 3,

        /// <summary>The application is paused, or its sound is and the output pauses with it.</summary>
        Paused = 4,

        /// <summary>A panic silenced this touch; the next one sounds.</summary>
        Panic = 5,

        /// <summary>The device changed its sample rate and the worker is still preparing for it, or the rate is outside
        /// 8 to 192 kHz.</summary>
        Rate = 6,

        /// <summary>The voice is being closed.</summary>
        Closing = 7,

        /// <summary>The worker thread has ended: <see cref="HapticEngine.LastFailure"/> says why.</summary>
        WorkerDead = 8,

        /// <summary>The strength or the ceiling is 0.</summary>
        TurnedDown = 9,
    }
}
