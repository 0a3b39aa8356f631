#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Numerics;
using HaptoFlow.Outputs;

namespace HaptoFlow.DeviceCheck
{
    /// <summary>What a part of the check measured, and its lines.</summary>
    internal abstract record Facts
    {
        public abstract void AddTo(List<CheckLine> lines);
    }

    /// <summary>Blocks of the audio thread during a simulated stroke.</summary>
    /// <param name="Bytes">Bytes allocated in all blocks; null where the runtime does not count.</param>
    internal sealed record CallbackFacts(
        float[] Milliseconds, int Blocks, double Seconds, int SampleRateHz, int BlockFrames, long? Bytes) : Facts
    {
        public override void AddTo(List<CheckLine> lines)
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
            double late = Percentile(0.99);
            float worst = Milliseconds[Milliseconds.Length - 1];
            lines.Add(CheckLine.Of(Group, "time for a block", late <= LargestShare * blockMs && worst < blockMs,
                FormattableString.Invariant($"median {Percentile(0.5):0.000} ms, ") +
                FormattableString.Invariant($"99th percentile {late:0.000} ms, worst {worst:0.000} ms, ") +
                FormattableString.Invariant($"of {blockMs:0.0} ms"),
                Remedy));
            lines.Add(Bytes == null
                ? CheckLine.Skipped(Group, "allocations", "this runtime does not count bytes for each thread")
                : CheckLine.Of(Group, "allocations", Bytes == 0, $"{Bytes} bytes in {Blocks} blocks",
                    "Tell us: HaptoFlow allocates nothing there in its own tests."));
        }

        private float Percentile(double share) =>
            Milliseconds[Math.Min(Milliseconds.Length - 1, (int)(share * Milliseconds.Length))];
    }

    /// <summary>The engine during a simulated stroke, with one contact state a frame.</summary>
    /// <param name="Failure">Message of the last failure; empty without one.</param>
    /// <param name="Runs">Inferences that the two times come from.</param>
    /// <param name="Late">Segments that came late, and blocks without a segment.</param>
    internal sealed record EngineFacts(
        bool WorkerIsAlive, bool PriorityWasRefused, ulong FailedRounds, string Failure, double BudgetMs, double MedianMs,
        double Percentile99Ms, ulong Runs, ulong Segments, ulong Late, double FramesHz, double DisplayHz) : Facts
    {
        public override void AddTo(List<CheckLine> lines)
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
    /// <param name="WasAccepted">False where the platform refused the change.</param>
    /// <param name="BlocksAfter">Blocks that were rendered after the change.</param>
    /// <param name="SegmentsAfter">Segments that were generated after the change.</param>
    internal sealed record ConfigurationFacts(
        int SampleRateHz, int BlockFrames, bool WasAccepted, int AskedFrames, int NewFrames = 0, int BlocksAfter = 0,
        ulong SegmentsAfter = 0) : Facts
    {
        public override void AddTo(List<CheckLine> lines)
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
    internal sealed record PauseFacts(
        bool Happened = false, double Seconds = 0.0, bool EngineIsReady = false, int BlocksAfter = 0,
        ulong SegmentsAfter = 0) : Facts
    {
        public override void AddTo(List<CheckLine> lines) => lines.Add(!Happened
            ? CheckLine.Skipped("Pause", "pause and resume", "the application was not paused")
            : CheckLine.Of("Pause", "pause and resume", EngineIsReady && BlocksAfter > 0 && SegmentsAfter > 0,
                FormattableString.Invariant($"{Seconds:0.0} s of pause; {BlocksAfter} blocks and ") +
                $"{SegmentsAfter} segments afterwards",
                "Call Haptics.Restart after a pause, and tell us."));
    }

    /// <summary>The native libraries, as calls that may throw.</summary>
    /// <param name="RequireAgreement">Throws where version or struct sizes differ from the scripts'.</param>
    /// <param name="OpenOnnxRuntime">Throws where ONNX Runtime is missing or too old.</param>
    internal sealed record LibraryFacts(
        Func<string> Version, Action RequireAgreement, Action OpenOnnxRuntime, int Structs) : Facts
    {
        public override void AddTo(List<CheckLine> lines)
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
    /// <param name="Routes">Names of the registered routes to devices: their methods run by an attribute.</param>
    /// <param name="ExpectsRoutes">True where the project has Unity's XR module, which brings two routes.</param>
    /// <param name="HasModel">True where the settings are the project's, or the scene's, with a model.</param>
    /// <param name="Callback">The first word that the library reported by a managed callback; empty where none came.</param>
    /// <param name="CallbackProblem">Why learning ended before a callback came; null where it did not.</param>
    /// <param name="CallbackSkipped">Why no callback could be tried; null where it was.</param>
    internal sealed record AttributeFacts(
        IReadOnlyList<string> Routes, bool ExpectsRoutes, bool HasModel, string Callback = "",
        string? CallbackProblem = null, string? CallbackSkipped = null) : Facts
    {
        public override void AddTo(List<CheckLine> lines)
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
    /// <param name="Seconds">Time from the request until it could be used.</param>
    internal sealed record ModelFacts(
        string? Problem, double Seconds, IReadOnlyList<string> Labels, IReadOnlyList<string> Tiers) : Facts
    {
        public override void AddTo(List<CheckLine> lines)
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

    /// <summary>One route to the device in a hand, after a test wave.</summary>
    /// <param name="RateHz">The rate that the device reports; 0 for one value a frame.</param>
    /// <param name="MaximumSamples">Largest buffer, in samples; of waveforms only.</param>
    /// <param name="Refused">Submissions that were refused, or taken only in part.</param>
    internal sealed record RouteFacts(
        string Hand, string Route, HapticForm Form, string Device, double RateHz, int MaximumSamples, long Submissions,
        long Refused, long Gaps) : Facts
    {
        public override void AddTo(List<CheckLine> lines)
        {
            string rate = RateHz > 0.0 ? FormattableString.Invariant($"{RateHz:0.#} Hz") : "one value a frame";
            string largest = Form == HapticForm.Waveform && MaximumSamples < int.MaxValue
                ? $", buffers of up to {MaximumSamples} samples" : "";
            lines.Add(CheckLine.Of("Devices", $"{Hand} hand, {Route}", Submissions > 0 && Refused == 0 && Gaps == 0,
                $"{Device}: {Form.ToString().ToLowerInvariant()}, {rate}{largest}; " +
                $"{Submissions - Refused} of {Submissions} submissions accepted, {Gaps} gaps",
                Form == HapticForm.Waveform
                    ? "Switch on Queue Submissions of a Controller Waveform Output, or use a Motor Output, and send " +
                        "this page."
                    : "Update the device's firmware and its runtime, use another output, and send this page."));
        }

        /// <summary>For a hand without any device that vibrates.</summary>
        public static CheckLine None(string hand) => CheckLine.Skipped("Devices", hand + " hand, any route",
            "no device that vibrates was found; switch it on and run the check again");
    }

    /// <summary>What a stylus's device reported at rest and during strokes.</summary>
    internal sealed class StylusProbe
    {
        private readonly List<float> restForces = new List<float>();
        private readonly List<float> pressedForces = new List<float>();
        private readonly List<Double3> restTips = new List<Double3>();
        private Double3 lastTip;
        private bool hasTip;
        private int frames;
        private int trackedFrames;
        private int newPoses;
        private double seconds;

        /// <param name="pressNewtons">The force at which a touch would begin.</param>
        public StylusProbe(string name, double pressNewtons) => (Name, PressNewtons) = (name, pressNewtons);

        public string Name { get; }

        public double PressNewtons { get; }

        /// <param name="isPressing">True while the user is asked to stroke, false while the stylus is to rest.</param>
        /// <param name="tip">Centre of the tip in m; null while it is not tracked.</param>
        public void Add(bool isPressing, double frameSeconds, Double3? tip, float? forceNewtons)
        {
            if (forceNewtons is { } force)
            {
                (isPressing ? pressedForces : restForces).Add(force);
            }
            if (!isPressing)
            {
                if (tip is { } still)
                {
                    restTips.Add(still);
                }
                return;
            }
            ++frames;
            seconds += frameSeconds;
            if (tip is { } moved)
            {
                ++trackedFrames;
                newPoses += hasTip && (moved - lastTip).Length > 0.0 ? 1 : 0;
                lastTip = moved;
                hasTip = true;
            }
        }

        public void AddTo(List<CheckLine> lines, double displayHz)
        {
            AddForce(lines);
            AddTracking(lines, displayHz);
        }

        private void AddForce(List<CheckLine> lines)
        {
            const string Group = "Tip force";
            if (restForces.Count == 0 && pressedForces.Count == 0)
            {
                lines.Add(CheckLine.Skipped(Group, Name, "this stylus measures no force"));
                return;
            }
            (double mean, double deviation, double largest) = Of(restForces);
            lines.Add(CheckLine.Of(Group, Name + " at rest", restForces.Count > 0 && largest < PressNewtons,
                FormattableString.Invariant($"mean {mean:0.000} N, noise {deviation:0.0000} N, ") +
                FormattableString.Invariant($"largest {largest:0.000} N; a touch begins at {PressNewtons:0.000} N"),
                "Raise Press Force and Release Force of the Haptic Stylus, or Minimum Pressure of the pen, above the " +
                "largest value."));
            (double pressedMean, double _, double strongest) = Of(pressedForces);
            int levels = new HashSet<float>(pressedForces).Count;
            lines.Add(CheckLine.Of(Group, Name + " pressed", strongest >= 2.0 * PressNewtons && levels > 2,
                FormattableString.Invariant($"mean {pressedMean:0.000} N, largest {strongest:0.000} N, ") +
                $"{levels} different values",
                "Press harder and run again; otherwise set Newtons At Full Pressure of the pen, or choose another " +
                "source of the tip force."));
        }

        private void AddTracking(List<CheckLine> lines, double displayHz)
        {
            const string Group = "Tracking";
            const double LargestJitterMm = 0.5;
            if (restTips.Count == 0 && trackedFrames == 0)
            {
                lines.Add(CheckLine.Skipped(Group, Name, "this stylus was never tracked"));
                return;
            }
            double rate = seconds > 0.0 ? newPoses / seconds : 0.0;
            double wanted = 0.8 * (displayHz > 0.0 ? displayHz : frames / Math.Max(seconds, 1e-9));
            lines.Add(CheckLine.Of(Group, Name + " rate", trackedFrames >= 0.95 * frames && rate >= wanted,
                FormattableString.Invariant($"{rate:0.0} new poses/s, tracked in {trackedFrames} of {frames} frames"),
                "Keep the pen moving in sight of the headset's cameras during the strokes, and run again in good " +
                "light."));
            double jitter = JitterMillimetres();
            lines.Add(restTips.Count == 0
                ? CheckLine.Skipped(Group, Name + " jitter", "it was not tracked at rest")
                : CheckLine.Of(Group, Name + " jitter", jitter <= LargestJitterMm,
                    FormattableString.Invariant($"{jitter:0.000} mm around the mean at rest"),
                    "Lay the pen on a table in sight of the cameras, and run again in good light."));
        }

        /// <summary>Root mean square of the distances from the mean place.</summary>
        private double JitterMillimetres()
        {
            Double3 mean = default;
            foreach (Double3 each in restTips)
            {
                mean += each * (1.0 / restTips.Count);
            }
            double sum = 0.0;
            foreach (Double3 each in restTips)
            {
                double distance = (each - mean).Length;
                sum += distance * distance;
            }
            return restTips.Count > 0 ? 1000.0 * Math.Sqrt(sum / restTips.Count) : 0.0;
        }

        private static (double Mean, double Deviation, double Largest) Of(List<float> values)
        {
            double sum = 0.0;
            double squares = 0.0;
            double largest = 0.0;
            foreach (float value in values)
            {
                sum += value;
                squares += (double)value * value;
                largest = Math.Max(largest, value);
            }
            double count = Math.Max(1, values.Count);
            double mean = sum / count;
            return (mean, Math.Sqrt(Math.Max(0.0, squares / count - mean * mean)), largest);
        }
    }

    internal static class FeltQuestions
    {
        private const string Group = "Felt";

        public static IReadOnlyList<(string Name, string Question, string Remedy)> All { get; } = new[]
        {
            ("vibration", "Did you feel a vibration while the tip slid\nover a plate?",
                "Troubleshooting.md: nothing is felt. Check Scene names the output of each stylus."),
            ("stop", "Did it stop as soon as the tip stood still\nor was lifted?",
                "Look at the gaps and late segments above; on a pen, raise Release Force."),
            ("evenness", "Was it free of clicks, gaps and a hum\nthat has nothing to do with the plate?",
                "Switch on Queue Submissions of a Controller Waveform Output, or choose a larger DSP buffer."),
            ("difference", "Did the three plates feel different?",
                "Motors of one frequency show little of a texture: try another output, or an actuator."),
            ("delay", "Did it begin at once, without a delay\nthat you notice?",
                "Wireless audio adds 100 ms and more: use a cable or the controller (studies.md)."),
        };

        public static CheckLine Line(int question, bool? answer)
        {
            (string name, string _, string remedy) = All[question];
            return answer == null
                ? CheckLine.Unanswered(Group, name)
                : CheckLine.Of(Group, name, answer.Value, answer.Value ? "yes" : "no", remedy);
        }
    }
}
