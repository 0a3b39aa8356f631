#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.DeviceCheck
{
    /// <summary>Blocks of the audio thread during a simulated stroke.</summary>
    internal struct CallbackFacts
    {
        /// <summary>Render times, ascending, in ms.</summary>
        public float[] Milliseconds;

        public int Blocks;
        public double Seconds;
        public int SampleRateHz;
        public int BlockFrames;

        /// <summary>Bytes allocated in all blocks; null where the runtime does not count.</summary>
        public long? Bytes;

        public void AddTo(List<CheckLine> lines)
        {
            const string Group = "Audio thread";
            const double LargestShare = 0.25;
            const string Remedy = "Choose a larger DSP buffer in Project Settings > Audio, or a cheaper quality " +
                "(live-engine.md).";
            double blockMs = SampleRateHz > 0 ? 1000.0 * BlockFrames / SampleRateHz : 0.0;
            double expected = blockMs > 0.0 ? Seconds * 1000.0 / blockMs : 0.0;
            lines.Add(CheckLine.Of(Group, "callbacks", Blocks > 0 && Blocks >= 0.9 * expected,
                FormattableString.Invariant($"{Blocks} in {Seconds:0.0} s, expected {expected:0}"),
                "Add an Audio Listener to the scene and switch off Project Settings > Audio > Disable Unity Audio."));
            if (Milliseconds.Length == 0)
            {
                lines.Add(CheckLine.Skipped(Group, "time for a block", "no block came"));
                lines.Add(CheckLine.Skipped(Group, "allocations", "no block came"));
                return;
            }
            double late = Percentiles.Of(Milliseconds, 0.99);
            float worst = Milliseconds[Milliseconds.Length - 1];
            lines.Add(CheckLine.Of(Group, "time for a block", late <= LargestShare * blockMs && worst < blockMs,
                FormattableString.Invariant($"median {Percentiles.Of(Milliseconds, 0.5):0.000} ms, ") +
                FormattableString.Invariant($"99th percentile {late:0.000} ms, worst {worst:0.000} ms, ") +
                FormattableString.Invariant($"of {blockMs:0.0} ms"),
                Remedy));
            lines.Add(Bytes == null
                ? CheckLine.Skipped(Group, "allocations", "this runtime does not count bytes for each thread")
                : CheckLine.Of(Group, "allocations", Bytes == 0, $"{Bytes} bytes in {Blocks} blocks",
                    "Tell us: HaptoFlow allocates nothing there in its own tests."));
        }
    }

    /// <summary>The engine during a simulated stroke, with one contact state a frame.</summary>
    internal struct EngineFacts
    {
        public bool WorkerIsAlive;
        public bool PriorityWasRefused;
        public ulong FailedRounds;

        /// <summary>Message of the last failure; empty without one.</summary>
        public string Failure;

        public double BudgetMs;
        public double MedianMs;
        public double Percentile99Ms;

        /// <summary>Inferences that the two times come from.</summary>
        public ulong Runs;

        public ulong Segments;

        /// <summary>Segments that came late, and blocks without a segment.</summary>
        public ulong Late;

        /// <summary>Measured rate of frames.</summary>
        public double FramesHz;

        /// <summary>Reported rate of the display; 0 where unknown.</summary>
        public double DisplayHz;

        public void AddTo(List<CheckLine> lines)
        {
            const string Group = "Engine";
            const double LargestLateShare = 0.01;
            const string Slow = "Choose a cheaper quality in Project Settings > HaptoFlow, or Auto (live-engine.md).";
            bool works = WorkerIsAlive && FailedRounds == 0;
            lines.Add(CheckLine.Of(Group, "worker", works,
                works ? "alive, no failed round" : $"{FailedRounds} failed rounds: {Failure}",
                "Troubleshooting.md explains the message; restart the engine with Haptics.Restart."));
            lines.Add(CheckLine.Of(Group, "worker's priority", !PriorityWasRefused,
                PriorityWasRefused ? "refused by the system" : "as requested, or not needed",
                "Segments are late more often without it; on Linux allow the user real-time priorities."));
            lines.Add(Runs == 0
                ? CheckLine.Of(Group, "time for a segment", false, "no segment was generated", Slow)
                : CheckLine.Of(Group, "time for a segment", Percentile99Ms <= BudgetMs,
                    FormattableString.Invariant($"median {MedianMs:0.00} ms, 99th percentile ") +
                    FormattableString.Invariant($"{Percentile99Ms:0.00} ms, of {BudgetMs:0.0} ms, {Runs} runs"), Slow));
            lines.Add(CheckLine.Of(Group, "late segments", Segments > 0 && Late <= LargestLateShare * Segments,
                $"{Late} late or missing of {Segments}", Slow));
            lines.Add(DisplayHz <= 0.0
                ? CheckLine.Skipped(Group, "display's rate", FormattableString.Invariant(
                    $"the display reports no rate; {FramesHz:0.0} frames/s"))
                : CheckLine.Of(Group, "display's rate", FramesHz >= 0.9 * DisplayHz, FormattableString.Invariant(
                    $"{FramesHz:0.0} frames/s of {DisplayHz:0.0} Hz"),
                    "Contact states come once a frame: make the scene cheaper to draw, or close other programs."));
        }
    }

    /// <summary>The audio device's configuration, and what a change of it did.</summary>
    internal struct ConfigurationFacts
    {
        public int SampleRateHz;
        public int BlockFrames;

        /// <summary>False where the platform refused the change.</summary>
        public bool WasAccepted;

        public int AskedFrames;
        public int NewFrames;

        /// <summary>Blocks that were rendered after the change.</summary>
        public int BlocksAfter;

        /// <summary>Segments that were generated after the change.</summary>
        public ulong SegmentsAfter;

        public void AddTo(List<CheckLine> lines)
        {
            const string Group = "Audio device";
            const double LongestMs = 25.0;
            double blockMs = SampleRateHz > 0 ? 1000.0 * BlockFrames / SampleRateHz : double.PositiveInfinity;
            lines.Add(CheckLine.Of(Group, "configuration",
                SampleRateHz >= 8000 && SampleRateHz <= 192000 && blockMs <= LongestMs,
                FormattableString.Invariant($"{SampleRateHz} Hz, blocks of {BlockFrames} frames ({blockMs:0.0} ms)"),
                "In Project Settings > Audio choose the DSP Buffer Size Best latency, and 8 to 192 kHz."));
            lines.Add(!WasAccepted
                ? CheckLine.Skipped(Group, "change of configuration", "the platform refused another block length")
                : CheckLine.Of(Group, "change of configuration", BlocksAfter > 0 && SegmentsAfter > 0,
                    $"{BlockFrames} frames, {AskedFrames} asked, {NewFrames} came: {BlocksAfter} blocks and " +
                    $"{SegmentsAfter} segments afterwards",
                    "Restart the scene after plugging in another audio device, and tell us."));
        }
    }

    /// <summary>The way into a pause and back.</summary>
    internal struct PauseFacts
    {
        /// <summary>True where the application was paused during the check.</summary>
        public bool Happened;

        public double Seconds;
        public bool EngineIsReady;
        public int BlocksAfter;
        public ulong SegmentsAfter;

        public void AddTo(List<CheckLine> lines) => lines.Add(!Happened
            ? CheckLine.Skipped("Pause", "pause and resume", "the application was not paused")
            : CheckLine.Of("Pause", "pause and resume", EngineIsReady && BlocksAfter > 0 && SegmentsAfter > 0,
                FormattableString.Invariant($"{Seconds:0.0} s of pause; {BlocksAfter} blocks and ") +
                $"{SegmentsAfter} segments afterwards",
                "Call Haptics.Restart after a pause, and tell us."));
    }

    /// <summary>Percentiles of sorted values.</summary>
    internal static class Percentiles
    {
        /// <param name="sorted">Ascending; at least one.</param>
        /// <param name="share">0 to 1.</param>
        public static float Of(float[] sorted, double share) =>
            sorted[Math.Min(sorted.Length - 1, (int)(share * sorted.Length))];
    }
}
