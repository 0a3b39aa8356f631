#nullable enable
using System.Runtime.InteropServices;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>Statistics of a voice since it was opened. Fields are counts unless their name says
    /// otherwise.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct VoiceStatistics
    {
        internal uint StructSize;

        /// <summary>Lead of new segments, in samples of 0.5 ms.</summary>
        public uint LeadSamples;

        /// <summary>Contact states published.</summary>
        public ulong Updates;

        /// <summary>Segments generated.</summary>
        public ulong Inferences;

        /// <summary>Contact states for which no segment was generated.</summary>
        public ulong Skipped;

        /// <summary>Touches that started to sound.</summary>
        public ulong Onsets;

        /// <summary>Touches shorter than a block.</summary>
        public ulong Taps;

        /// <summary>Blocks that needed samples without a segment.</summary>
        public ulong Underruns;

        /// <summary>Segments that arrived late.</summary>
        public ulong Late;

        /// <summary>Segments that were discarded.</summary>
        public ulong Dropped;

        /// <summary>Runs of the network that failed.</summary>
        public ulong Failures;

        /// <summary>Fields of contact states that were not finite or out of range and were corrected.</summary>
        public ulong Sanitised;

        /// <summary>Touches silenced because no contact state came for 100 ms.</summary>
        public ulong StaleStops;

        /// <summary>Output samples that were not finite and were replaced by 0.</summary>
        public ulong NonFiniteSamples;

        /// <summary>Output samples above the limiter's knee.</summary>
        public ulong LimitedSamples;

        /// <summary>Output frames rendered.</summary>
        public ulong RenderedFrames;

        /// <summary>Changes of the output's sample rate.</summary>
        public ulong RateChanges;

        /// <summary>Calls refused because another thread was in the same call.</summary>
        public ulong RefusedCalls;

        /// <summary>Total time of this voice's inferences in milliseconds; the time of a batch is divided among its
        /// voices.</summary>
        public double InferenceMilliseconds;

        /// <summary>Number of times that a touch sounded again after a silence within it: a pause, a mute, a change of
        /// rate, or missing states.</summary>
        public ulong Resumptions;

        /// <summary>Blocks requested at a sample rate outside 8 to 192 kHz; they are silent.</summary>
        public ulong UnsupportedRateBlocks;

        /// <summary>Sample rate of the last block, in Hz; 0 before the first.</summary>
        public double DeviceRateHz;

        /// <summary>Why the last block is silent; <see cref="HapticSilence.None"/> where it sounds.</summary>
        public HapticSilence Silence;

        private uint isRateSupported;

        /// <summary>False where the last block's rate is outside 8 to 192 kHz.</summary>
        public bool IsRateSupported => isRateSupported != 0;

        /// <summary>Impacts and edges that were lost, because more than 64 were published between two blocks; the
        /// strongest sound.</summary>
        public ulong LostContactEvents;
        /// <summary>Blocks in which the skeleton sounded alone: until the network's first segment of a touch, and while
        /// inference is late or fails.</summary>
        public ulong Sketched;
    }

    /// <summary>Why the exposure guard lowers a voice.</summary>
    public enum HapticExposureReason
    {
        /// <summary>The voice is not lowered.</summary>
        None = 0,

        /// <summary>A high level for minutes.</summary>
        ShortTerm = 1,

        /// <summary>The daily dose, weighted according to ISO 5349-1.</summary>
        Dose = 2,
    }

    /// <summary>Measurements of a voice's exposure guard after the last block.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct HapticExposure
    {
        internal uint StructSize;

        /// <summary>Why the level is lowered now.</summary>
        public HapticExposureReason Reason;

        /// <summary>Gain of the guard; 1 while nothing is lowered.</summary>
        public double Gain;

        /// <summary>Equivalent level of the last minutes without the guard, in m/s^2.</summary>
        public double ShortTermMps2;

        /// <summary>Daily exposure A(8) of what reached the hand, in m/s^2.</summary>
        public double DailyMps2;

        /// <summary>Time for which the level has been lowered, in seconds.</summary>
        public double LoweredSeconds;
    }

    /// <summary>Statistics of one stage of a voice since the voice was opened; all zero for a stage that never
    /// ran.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct EffectStatistics
    {
        internal uint StructSize;
        private uint isAskedFor;

        /// <summary>Number of times that the stage was prepared.</summary>
        public ulong Prepared;

        /// <summary>Blocks processed; for the texture, segments.</summary>
        public ulong Runs;

        /// <summary>Samples processed: of the texture at 2 kHz, of others at the output's rate.</summary>
        public ulong Samples;

        /// <summary>Total processing time in microseconds.</summary>
        public double Microseconds;

        /// <summary>Impacts and edges played; for signal and clip, their starts.</summary>
        public ulong Events;

        /// <summary>True while the stage is in use; for impact and edge, while the newest contact state has the
        /// effect.</summary>
        public bool IsAskedFor => isAskedFor != 0;
    }

    /// <summary>Number and delays of a signal's starts and stops caused by contact states. A delay runs from publishing
    /// the first state that requires the change to the start of the block in which it happens, the voice's delay
    /// included; compensation and device add to it. Changes by mute, pause, panic, missing states or <see
    /// cref="HapticVoice.SetSignal"/> are not counted.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct SignalStatistics
    {
        internal uint StructSize;

        /// <summary>Starts since the voice was opened.</summary>
        public ulong Starts;

        /// <summary>Stops since the voice was opened.</summary>
        public ulong Stops;

        /// <summary>Delay of the last start, in seconds; 0 before the first.</summary>
        public double LastStartLatencySeconds;

        /// <summary>Delay of the last stop, in seconds; 0 before the first.</summary>
        public double LastStopLatencySeconds;

        /// <summary>Mean delay of all starts, in seconds.</summary>
        public double MeanStartLatencySeconds;

        /// <summary>Mean delay of all stops, in seconds.</summary>
        public double MeanStopLatencySeconds;
    }

    /// <summary>Statistics of an engine since it was created. Fields are counts unless their name says
    /// otherwise.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct EngineStatistics
    {
        internal uint StructSize;

        /// <summary>Index of the tier in use.</summary>
        public uint Tier;

        /// <summary>Number of open voices.</summary>
        public uint Voices;

        private uint isMeasuring;

        /// <summary>Rounds of inference.</summary>
        public ulong Rounds;

        /// <summary>Segments generated in them.</summary>
        public ulong Segments;

        /// <summary>Rounds in which a graph failed.</summary>
        public ulong FailedRounds;

        /// <summary>Number of times that the worker was woken.</summary>
        public ulong Wakes;

        /// <summary>Number of times that automatic quality switched to a cheaper tier.</summary>
        public ulong QualityStepsDown;

        /// <summary>Number of times that automatic quality switched to a more accurate tier.</summary>
        public ulong QualityStepsUp;

        /// <summary>Time budget of a round, in ms.</summary>
        public double BudgetMs;

        /// <summary>Time of the last round for all its voices, in ms.</summary>
        public double LastRoundMs;

        private uint workerIsAlive;
        private uint priorityWasRefused;

        /// <summary>False after the worker thread has ended; true for an engine without worker.</summary>
        public bool WorkerIsAlive => workerIsAlive != 0;

        /// <summary>True where the system refused the worker a raised priority: segments are late more often.</summary>
        public bool PriorityWasRefused => priorityWasRefused != 0;

        /// <summary>True while automatic quality is measuring.</summary>
        public bool IsMeasuring => isMeasuring != 0;
    }

    /// <summary>Measured inference times of one tier for one voice's segment on this machine.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct TierTimes
    {
        internal uint StructSize;
        private uint isCurrent;

        /// <summary>Number of runs measured, at most the last 128; 0 where the tier was neither used nor
        /// measured.</summary>
        public ulong Runs;

        /// <summary>Median time in ms.</summary>
        public double MedianMs;

        /// <summary>99th percentile in ms.</summary>
        public double Percentile99Ms;

        /// <summary>True for the tier in use.</summary>
        public bool IsCurrent => isCurrent != 0;
    }

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
