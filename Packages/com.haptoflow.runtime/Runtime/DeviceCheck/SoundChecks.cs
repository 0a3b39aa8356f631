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

    /// <summary>The native libraries, as calls that may throw.</summary>
    internal sealed class LibraryFacts
    {
        /// <summary>The library's version.</summary>
        public Func<string> Version { get; set; } = () => "";

        /// <summary>Throws where version or struct sizes differ from the scripts'.</summary>
        public Action RequireAgreement { get; set; } = () => { };

        /// <summary>Throws where ONNX Runtime is missing or too old.</summary>
        public Action OpenOnnxRuntime { get; set; } = () => { };

        /// <summary>Number of structs that cross the border.</summary>
        public int Structs { get; set; }

        public void AddTo(List<CheckLine> lines)
        {
            const string Group = "Library";
            const string Install = "Install the package again and restart; for a player, check that it has a library " +
                "for its platform (installation.md).";
            lines.Add(Tried(Group, "native library", () => "version " + Version(), Install));
            lines.Add(Tried(Group, "struct sizes", () =>
            {
                RequireAgreement();
                return $"{Structs} structs and the version are the same in library and scripts";
            }, Install));
            lines.Add(Tried(Group, "ONNX Runtime", () =>
            {
                OpenOnnxRuntime();
                return "opened";
            }, "Install com.github.asus4.onnxruntime 0.4.9, and its libraries for this platform."));
        }

        private static CheckLine Tried(string group, string name, Func<string> attempt, string remedy)
        {
            try
            {
                return CheckLine.Of(group, name, true, attempt(), remedy);
            }
            catch (Exception error)
            {
                return CheckLine.Of(group, name, false, error.Message, remedy);
            }
        }
    }

    /// <summary>What the runtime finds only by attributes, which code stripping and IL2CPP may drop.</summary>
    internal struct AttributeFacts
    {
        /// <summary>Names of the registered routes to devices: their methods run by an attribute.</summary>
        public IReadOnlyList<string> Routes;

        /// <summary>True where the project has Unity's XR module, which brings two routes.</summary>
        public bool ExpectsRoutes;

        /// <summary>True where the settings are the project's, or the scene's, with a model.</summary>
        public bool HasModel;

        /// <summary>The first word that the library reported by a managed callback; empty where none came.</summary>
        public string Callback;

        /// <summary>Why learning ended before a callback came; null where it did not.</summary>
        public string? CallbackProblem;

        /// <summary>Why no callback could be tried; null where it was.</summary>
        public string? CallbackSkipped;

        public void AddTo(List<CheckLine> lines)
        {
            const string Group = "Attributes and stripping";
            string listed = Routes.Count > 0 ? string.Join(", ", Routes) : "none";
            lines.Add(Routes.Count == 0 && !ExpectsRoutes
                ? CheckLine.Skipped(Group, "routes to devices", "the project has no package with a route to a device")
                : CheckLine.Of(Group, "routes to devices", Routes.Count > 0, listed,
                    "Lower Managed Stripping Level in the player's settings and tell us: methods with " +
                    "RuntimeInitializeOnLoadMethod did not run."));
            lines.Add(CheckLine.Of(Group, "settings and model", HasModel, HasModel ? "found" : "no model",
                "Create settings in Project Settings > HaptoFlow and build again."));
            const string Call = "callback from the library";
            lines.Add(CallbackSkipped != null
                ? CheckLine.Skipped(Group, Call, CallbackSkipped)
                : CheckLine.Of(Group, Call, Callback.Length > 0,
                    Callback.Length > 0 ? $"\"{Callback}\"" : CallbackProblem ?? "none came",
                    "Materials cannot be learnt in this player; learn them in the editor and tell us: " +
                    "MonoPInvokeCallback was not recognised."));
        }
    }

    /// <summary>A further loading of the settings' model.</summary>
    internal struct ModelFacts
    {
        /// <summary>Why it failed; null where it did not.</summary>
        public string? Problem;

        /// <summary>Time from the request until it could be used, in s.</summary>
        public double Seconds;

        public IReadOnlyList<string> Labels;
        public IReadOnlyList<string> Tiers;

        public void AddTo(List<CheckLine> lines)
        {
            const string Group = "Model";
            const double LongestSeconds = 10.0;
            string remedy = Problem != null
                ? "Import the model again; troubleshooting.md names every message."
                : "Load it before the first touch (Haptics.Prepare), or choose a cheaper quality.";
            lines.Add(CheckLine.Of(Group, "loading", Problem == null && Seconds <= LongestSeconds,
                Problem ?? FormattableString.Invariant($"{Seconds:0.00} s, goal {LongestSeconds:0} s"), remedy));
            lines.Add(CheckLine.Of(Group, "labels", Labels.Count > 0, $"{Labels.Count}: {string.Join(", ", Labels)}",
                "Choose a model with labels in Project Settings > HaptoFlow."));
            lines.Add(CheckLine.Of(Group, "tiers", Tiers.Count > 0, $"{Tiers.Count}: {string.Join(", ", Tiers)}",
                "Choose a model with tiers in Project Settings > HaptoFlow."));
        }
    }
}
