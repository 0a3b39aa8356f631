#nullable enable
using System.Runtime.InteropServices;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>What one voice did since it was opened. Counts unless the name says otherwise.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct VoiceStatistics
    {
        internal uint StructSize;

        /// <summary>Waveform samples by which a new segment leads what sounds; 2 samples are 1 ms.</summary>
        public uint LeadSamples;

        /// <summary>Contact states published.</summary>
        public ulong Updates;

        /// <summary>Segments generated.</summary>
        public ulong Inferences;

        /// <summary>Contact states for which nothing was generated.</summary>
        public ulong Skipped;

        /// <summary>Touches that began to sound.</summary>
        public ulong Onsets;

        /// <summary>Touches that were over within one block.</summary>
        public ulong Taps;

        /// <summary>Blocks that wanted samples which no segment covered.</summary>
        public ulong Underruns;

        /// <summary>Segments that came late.</summary>
        public ulong Late;

        /// <summary>Segments that came for nothing.</summary>
        public ulong Dropped;

        /// <summary>Runs of the network that failed.</summary>
        public ulong Failures;

        /// <summary>Fields of contact states that were not finite or out of range, and were made so.</summary>
        public ulong Sanitised;

        /// <summary>Touches silenced because no contact state came for 100 ms.</summary>
        public ulong StaleStops;

        /// <summary>Output samples that were not finite, and became 0.</summary>
        public ulong NonFiniteSamples;

        /// <summary>Output samples bent by the limiter.</summary>
        public ulong LimitedSamples;

        /// <summary>Output frames rendered.</summary>
        public ulong RenderedFrames;

        /// <summary>Changes of the output's sample rate.</summary>
        public ulong RateChanges;

        /// <summary>Calls refused because another thread was inside.</summary>
        public ulong RefusedCalls;

        /// <summary>Milliseconds that this voice's inferences took in all; voices that share a run share its
        /// time.</summary>
        public double InferenceMilliseconds;

        /// <summary>How often a touch sounded again after a silence within it: a pause, a mute, a change of rate,
        /// missing states.</summary>
        public ulong Resumptions;

        /// <summary>Blocks asked for at a sample rate outside 8 to 192 kHz: all of them are silent.</summary>
        public ulong UnsupportedRateBlocks;

        /// <summary>Sample rate of the newest block, in Hz; 0 before the first.</summary>
        public double DeviceRateHz;

        /// <summary>Why the newest block is silent; <see cref="HapticSilence.None"/> where it sounds.</summary>
        public HapticSilence Silence;

        private uint isRateSupported;

        /// <summary>False while the newest block's rate is outside 8 to 192 kHz.</summary>
        public bool IsRateSupported => isRateSupported != 0;
    }

    /// <summary>Why the exposure guard lowers a voice.</summary>
    public enum HapticExposureReason
    {
        /// <summary>It does not.</summary>
        None = 0,

        /// <summary>Minutes at a high level.</summary>
        ShortTerm = 1,

        /// <summary>The day's dose, weighted as ISO 5349-1 does.</summary>
        Dose = 2,
    }

    /// <summary>What a voice's exposure guard has measured, as the newest block left it.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct HapticExposure
    {
        internal uint StructSize;

        /// <summary>Why the level is lowered at present.</summary>
        public HapticExposureReason Reason;

        /// <summary>What the voice is multiplied by; 1 while nothing is lowered.</summary>
        public double Gain;

        /// <summary>Equivalent level of the last minutes as it would be without the guard, in m/s^2.</summary>
        public double ShortTermMps2;

        /// <summary>Daily exposure A(8) of what has reached the hand, in m/s^2.</summary>
        public double DailyMps2;

        /// <summary>For how long the level has been lowered, in seconds.</summary>
        public double LoweredSeconds;
    }

    /// <summary>What one stage of a voice did since the voice was opened; all zero for one that nobody asked for.
    /// </summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct EffectStatistics
    {
        internal uint StructSize;
        private uint isAskedFor;

        /// <summary>How often it was made ready.</summary>
        public ulong Prepared;

        /// <summary>Blocks that it ran for; of the texture, segments.</summary>
        public ulong Runs;

        /// <summary>Samples in them: of the texture at 2 kHz, of the others at the output's rate.</summary>
        public ulong Samples;

        /// <summary>What they took in all.</summary>
        public double Microseconds;

        /// <summary>Blows, of impact and edge; how often it began to sound, of the signal.</summary>
        public ulong Events;

        /// <summary>The voice asks for it at present: of impact and edge, its newest contact state.</summary>
        public bool IsAskedFor => isAskedFor != 0;
    }

    /// <summary>How often contact states have turned a voice's signal on and off, and what passed from publishing the
    /// first state that asked for it to the start of the block in which the change begins, the voice's delay included.
    /// What compensation and device add comes on top. Turns by mute, pause, panic, missing states or
    /// <see cref="HapticVoice.SetSignal"/> itself are not counted.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct SignalStatistics
    {
        internal uint StructSize;

        /// <summary>How often the signal was turned on since the voice was opened.</summary>
        public ulong Starts;

        /// <summary>How often it was turned off.</summary>
        public ulong Stops;

        /// <summary>Of the newest start, in seconds; 0 before the first.</summary>
        public double LastStartLatencySeconds;

        /// <summary>Of the newest stop, in seconds; 0 before the first.</summary>
        public double LastStopLatencySeconds;

        /// <summary>The mean of all starts, in seconds.</summary>
        public double MeanStartLatencySeconds;

        /// <summary>The mean of all stops, in seconds.</summary>
        public double MeanStopLatencySeconds;
    }

    /// <summary>What the engine did since it was made. Counts unless the name says otherwise.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct EngineStatistics
    {
        internal uint StructSize;

        /// <summary>Index of the tier that generates at present.</summary>
        public uint Tier;

        /// <summary>Voices open at present.</summary>
        public uint Voices;

        private uint isMeasuring;

        /// <summary>Rounds of inference.</summary>
        public ulong Rounds;

        /// <summary>Segments generated in them.</summary>
        public ulong Segments;

        /// <summary>Rounds in which a graph failed.</summary>
        public ulong FailedRounds;

        /// <summary>How often the worker was woken, for whatever reason.</summary>
        public ulong Wakes;

        /// <summary>How often automatic quality went to a cheaper tier.</summary>
        public ulong QualityStepsDown;

        /// <summary>How often automatic quality went to a more accurate tier.</summary>
        public ulong QualityStepsUp;

        /// <summary>What a round may take, in ms.</summary>
        public double BudgetMs;

        /// <summary>What the last round took, all its voices together, in ms.</summary>
        public double LastRoundMs;

        private uint workerIsAlive;
        private uint priorityWasRefused;

        /// <summary>False once the thread that generates has ended. True for an engine without one.</summary>
        public bool WorkerIsAlive => workerIsAlive != 0;

        /// <summary>The system did not let the worker run at a raised priority: segments come late more
        /// often.</summary>
        public bool PriorityWasRefused => priorityWasRefused != 0;

        /// <summary>Automatic quality still measures.</summary>
        public bool IsMeasuring => isMeasuring != 0;
    }

    /// <summary>Measured times of one tier for one voice's segment on this machine.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public struct TierTimes
    {
        internal uint StructSize;
        private uint isCurrent;

        /// <summary>Runs behind the figures; 0 where the tier was neither used nor measured. At most the last 128
        /// count.</summary>
        public ulong Runs;

        /// <summary>Half of the runs took less.</summary>
        public double MedianMs;

        /// <summary>Of a hundred runs 99 took less.</summary>
        public double Percentile99Ms;

        /// <summary>The tier generates at present.</summary>
        public bool IsCurrent => isCurrent != 0;
    }
}
