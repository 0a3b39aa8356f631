#nullable enable
using System;
using System.Collections;
using System.Collections.Generic;
using System.Diagnostics;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using HaptoFlow.DeviceCheck;
using HaptoFlow.Native;
using HaptoFlow.Numerics;
using UnityEngine;
using Debug = UnityEngine.Debug;
using Random = System.Random;

namespace HaptoFlow
{
    /// <summary>Tries on this device what HaptoFlow's own tests cannot: runs once when it is enabled in play mode, asks
    /// for what only a hand can do, and writes a page and a JSON file to share. Main thread; makes garbage.</summary>
    /// <remarks>While it runs, the audio device is restarted once with another block length, which stops the project's
    /// own sounds, and connected controllers vibrate.</remarks>
    [AddComponentMenu("HaptoFlow/Device Check")]
    [DefaultExecutionOrder(1200)]
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "device-check")]
    public sealed class DeviceCheckRun : MonoBehaviour
    {
        private const double LongestLoadingSeconds = 60.0;
        private const double LongestCallbackSeconds = 20.0;
        private const double SettlingSeconds = 1.0;
        private const double StrokeSeconds = 5.0;
        private const double RouteSeconds = 1.5;
        private const double ReadSeconds = 4.0;
        private const double RestSeconds = 3.0;
        private const double PressSeconds = 8.0;
        private const double PauseSeconds = 30.0;
        private const double AfterSeconds = 1.5;

        // A stage returns null to wait for the next frame, or a time to wait for, in s.
        private readonly Queue<(string Name, IEnumerator Steps)> stages = new Queue<(string, IEnumerator)>();
        private DeviceCheckReport? report;
        private SimulatedStroke? stroke;
        private double resumeSeconds;
        private bool? answer;
        private bool hasSkipped;
        private double pausedSeconds;
        private double beganPauseSeconds = double.NaN;
        private bool wasPaused;

        /// <summary>What the user should do now, in lines of about 60 characters.</summary>
        public string Instruction { get; private set; } = "";

        /// <summary>True while a question waits for <see cref="Answer"/> or <see cref="Skip"/>.</summary>
        public bool IsAsking { get; private set; }

        /// <summary>True when the files were written, or could not be.</summary>
        public bool IsFinished { get; private set; }

        /// <summary>Path of the page; empty before it was written.</summary>
        public string PagePath { get; private set; } = "";

        /// <summary>The folder of both files; null for HaptoFlow in Application.persistentDataPath.</summary>
        internal string? Folder { get; set; }

        internal DeviceCheckReport Report => report!;

        /// <summary>Answers the question that is asked; ignored while none is.</summary>
        public void Answer(bool isYes) => answer = IsAsking ? isYes : (bool?)null;

        /// <summary>Leaves the present question, or the wait for a pause.</summary>
        public void Skip() => hasSkipped = true;

        private void Start()
        {
            report = new DeviceCheckReport(Surroundings());
            foreach ((string name, IEnumerator steps) in new (string, IEnumerator)[]
            {
                ("Library", TryLibrary()), ("Model", TryModel()), ("Attributes and stripping", TryAttributes()),
                ("Audio thread", TryStroke()), ("Audio device", TryConfiguration()), ("Devices", TryRoutes()),
                ("Tip force and tracking", TryStyluses()), ("Pause", TryPause()), ("Felt", Ask()),
            })
            {
                stages.Enqueue((name, steps));
            }
        }

        private void Update()
        {
            if (IsFinished)
            {
                return;
            }
            if (stages.Count == 0)
            {
                Finish();
                return;
            }
            (string name, IEnumerator steps) = stages.Peek();
            try
            {
                stroke?.Publish();
                if (Now < resumeSeconds)
                {
                    return;
                }
                if (steps.MoveNext())
                {
                    resumeSeconds = steps.Current is double seconds ? Now + seconds : 0.0;
                    return;
                }
            }
            catch (Exception error)
            {
                Report.Lines.Add(CheckLine.Of(name, "this part of the check", false, "ended early: " + error.Message,
                    "Run the check again and send this page."));
                EndStroke();
            }
            IsAsking = false;
            stages.Dequeue();
        }

        private void OnApplicationPause(bool paused)
        {
            double now = Time.realtimeSinceStartupAsDouble;
            if (paused)
            {
                beganPauseSeconds = now;
            }
            else if (!double.IsNaN(beganPauseSeconds))
            {
                wasPaused = true;
                pausedSeconds = now - beganPauseSeconds;
                beganPauseSeconds = double.NaN;
            }
        }

        private void OnDestroy()
        {
            if (stages.Count > 0)
            {
                // Leaves what has begun: restores the audio device, stops the vibration.
                (stages.Peek().Steps as IDisposable)?.Dispose();
            }
            EndStroke();
        }

        private void OnGUI()
        {
            const float Margin = 10f;
            const float Width = 620f;
            const float Height = 30f;
            float top = Margin;
            foreach (string line in Instruction.Split('\n'))
            {
                GUI.Label(new Rect(Margin, top, Width, Height), line);
                top += 0.7f * Height;
            }
            if (IsAsking && GUI.Button(new Rect(Margin, top, 100f, Height), "Yes"))
            {
                Answer(true);
            }
            if (IsAsking && GUI.Button(new Rect(Margin + 110f, top, 100f, Height), "No"))
            {
                Answer(false);
            }
            if (!IsFinished && GUI.Button(new Rect(Margin + 220f, top, 100f, Height), "Skip"))
            {
                Skip();
            }
        }

        private IEnumerator TryLibrary()
        {
            Instruction = "Looking at the native library.";
            new LibraryFacts(OnnxRuntime.LibraryVersion, LibraryAgreement.Require, () => OnnxRuntime.Open().Dispose(),
                LibraryAgreement.Structs.Count).AddTo(Report.Lines);
            yield break;
        }

        private IEnumerator TryModel()
        {
            Instruction = "Loading the model.";
            // Otherwise the model of the scene could load at the same time.
            Haptics.Prepare();
            double end = Time.realtimeSinceStartupAsDouble + LongestLoadingSeconds;
            while (!Haptics.IsReady && Haptics.Problem == null && Time.realtimeSinceStartupAsDouble < end)
            {
                yield return null;
            }
            string[] tiers = Array.Empty<string>();
            double seconds = 0.0;
            HapticModelAsset? model = HaptoFlowSettings.Active.Model;
            string? problem = Haptics.Problem ??
                (model == null ? "no model is chosen" : Haptics.IsReady ? null : "it was not loaded within a minute");
            if (problem == null)
            {
                tiers = model!.Header.Tiers.Select(tier => tier.Name).ToArray();
                var clock = Stopwatch.StartNew();
                using HapticLoadedModel again = Haptics.Load(model, HaptoFlowSettings.Active.Quality);
                while (!again.IsReady && again.Problem == null && clock.Elapsed.TotalSeconds < LongestLoadingSeconds)
                {
                    yield return null;
                }
                problem = again.Problem;
                seconds = clock.Elapsed.TotalSeconds;
            }
            new ModelFacts(problem, seconds, Haptics.Labels, tiers).AddTo(Report.Lines);
        }

        private IEnumerator TryAttributes()
        {
            Instruction = "Looking at what code stripping may have removed.";
            HapticModelAsset? model = HaptoFlowSettings.Active.Model;
#if HAPTOFLOW_XR
            const bool ExpectsRoutes = true;
#else
            const bool ExpectsRoutes = false;
#endif
            var facts = new AttributeFacts(HapticSinks.Names(), ExpectsRoutes, model != null);
            if (model == null || Haptics.Problem != null)
            {
                facts = facts with { CallbackSkipped = "there is no model to learn a material for" };
            }
            else
            {
                using HapticLearning learning = HapticLearning.Start(
                    model.File, Noise(), new LearningOptions { Name = "device check" });
                var clock = Stopwatch.StartNew();
                while (learning.Doing.Length == 0 && !learning.IsCompleted &&
                    clock.Elapsed.TotalSeconds < LongestCallbackSeconds)
                {
                    yield return null;
                }
                facts = facts with { Callback = learning.Doing, CallbackProblem = learning.Problem };
                learning.Cancel();
                // Its inferences must not disturb what is measured next.
                while (!learning.IsCompleted)
                {
                    yield return null;
                }
            }
            facts.AddTo(Report.Lines);
        }

        private IEnumerator TryStroke()
        {
            HapticEngine? engine = HapticSession.Existing?.Engine;
            if (engine == null)
            {
                Report.Lines.Add(CheckLine.Skipped("Audio thread", "callbacks", "there is no engine"));
                Report.Lines.Add(CheckLine.Skipped("Engine", "worker", "there is no engine"));
                yield break;
            }
            Instruction = "Measuring audio thread and engine with a simulated stroke.\nYou may hear it. Please wait.";
            stroke = new SimulatedStroke(engine);
            yield return SettlingSeconds;
            VoiceStatistics before = stroke.Statistics;
            stroke.Record();
            double began = Now;
            int frames = 0;
            while (Now < began + StrokeSeconds)
            {
                yield return null;
                ++frames;
            }
            double seconds = Now - began;
            AudioSettings.GetDSPBufferSize(out int blockFrames, out _);
            new CallbackFacts(stroke.Blocks.SortedMilliseconds(), stroke.Blocks.Blocks, seconds,
                AudioSettings.outputSampleRate, blockFrames, stroke.Blocks.AllocatedBytes).AddTo(Report.Lines);
            VoiceStatistics after = stroke.Statistics;
            EngineStatistics statistics = engine.Statistics();
            TierTimes times = engine.Times((int)statistics.Tier);
            new EngineFacts(statistics.WorkerIsAlive, statistics.PriorityWasRefused, statistics.FailedRounds,
                engine.LastFailure(), statistics.BudgetMs, times.MedianMs, times.Percentile99Ms, times.Runs,
                Segments: after.Inferences - before.Inferences,
                Late: after.Late - before.Late + after.Underruns - before.Underruns,
                FramesHz: frames / seconds,
                DisplayHz: DisplayRate.TryGet(out double hertz) ? hertz : 0.0).AddTo(Report.Lines);
        }

        private IEnumerator TryConfiguration()
        {
            Instruction = "Restarting the audio device with another block length.";
            AudioConfiguration before = AudioSettings.GetConfiguration();
            AudioConfiguration asked = before;
            asked.dspBufferSize = before.dspBufferSize >= 1024 ? before.dspBufferSize / 2 : 2 * before.dspBufferSize;
            var facts = new ConfigurationFacts(AudioSettings.outputSampleRate, before.dspBufferSize,
                stroke != null && AudioSettings.Reset(asked), asked.dspBufferSize);
            if (facts.WasAccepted)
            {
                AudioSettings.GetDSPBufferSize(out int newFrames, out _);
                try
                {
                    ulong segments = stroke!.Statistics.Inferences;
                    stroke.Record();
                    yield return AfterSeconds;
                    facts = facts with
                    {
                        NewFrames = newFrames,
                        BlocksAfter = stroke.Blocks.Blocks,
                        SegmentsAfter = stroke.Statistics.Inferences - segments,
                    };
                }
                finally
                {
                    AudioSettings.Reset(before);
                }
            }
            facts.AddTo(Report.Lines);
            EndStroke();
        }

        private IEnumerator TryRoutes()
        {
            foreach (HapticHand hand in new[] { HapticHand.Left, HapticHand.Right })
            {
                Instruction = $"Vibrating what the {hand.InWords()} hand holds.\nPlease wait.";
                var trials = new List<RouteTrial>();
                HapticSinks.ForEach((route, form, maker) =>
                    trials.Add(new RouteTrial(hand.ToString(), route, form, maker(hand))));
                bool isAny = false;
                try
                {
                    // Routes ask for a device only every half second.
                    for (double end = Now + SettlingSeconds; Now < end && !trials.TrueForAll(each => each.HasDevice);)
                    {
                        yield return null;
                    }
                    foreach (RouteTrial trial in trials.FindAll(each => each.HasDevice))
                    {
                        isAny = true;
                        for (double end = Now + RouteSeconds; Now < end;)
                        {
                            trial.Update(Now);
                            yield return null;
                        }
                        trial.Facts().AddTo(Report.Lines);
                        trial.Stop(Now);
                    }
                }
                finally
                {
                    trials.ForEach(each => each.Dispose());
                }
                if (!isAny)
                {
                    Report.Lines.Add(RouteFacts.None(hand.ToString()));
                }
            }
        }

        private IEnumerator TryStyluses()
        {
            HapticStylus[] styluses = FindObjectsByType<HapticStylus>(
                FindObjectsInactive.Include, FindObjectsSortMode.None);
            (HapticStylus Stylus, StylusProbe Probe)[] probes = styluses.Select(stylus => (stylus, new StylusProbe(
                stylus.Hand == HapticHand.None ? stylus.name : stylus.Hand + " hand",
                stylus.ForceDecision.PressNewtons))).ToArray();
            if (probes.Length == 0)
            {
                Report.Lines.Add(CheckLine.Skipped("Tracking", "stylus", "the scene has no Haptic Stylus"));
            }
            foreach ((bool isPressing, double seconds, string words) in new[]
            {
                (false, RestSeconds, "Lay pen or controller on a table in sight of the headset,\nand touch nothing."),
                (true, PressSeconds, "Take it up again and stroke the plates to and fro, all the time,\n" +
                    "pressing once lightly and once as hard as in writing."),
            })
            {
                Instruction = words;
                yield return ReadSeconds;
                Instruction = words + "\nMeasuring.";
                double last = Now;
                for (double end = Now + seconds; Now < end;)
                {
                    yield return null;
                    foreach ((HapticStylus stylus, StylusProbe probe) in probes)
                    {
                        Add(stylus, probe, isPressing, Now - last);
                    }
                    last = Now;
                }
            }
            double displayHz = DisplayRate.TryGet(out double hertz) ? hertz : 0.0;
            Array.ForEach(probes, each => each.Probe.AddTo(Report.Lines, displayHz));
        }

        private IEnumerator TryPause()
        {
            HapticEngine? engine = HapticSession.Existing?.Engine;
            if (engine == null)
            {
                new PauseFacts().AddTo(Report.Lines);
                yield break;
            }
            stroke = new SimulatedStroke(engine);
            wasPaused = false;
            hasSkipped = false;
            Instruction = "Pause the application for a moment and come back:\n" +
                "open the headset's menu or take it off; on a phone\n" +
                "change to another application. In the editor, press Skip.";
            for (double end = Now + PauseSeconds; Now < end && !wasPaused && !hasSkipped;)
            {
                yield return null;
            }
            var facts = new PauseFacts(wasPaused, pausedSeconds);
            if (wasPaused)
            {
                ulong segments = stroke.Statistics.Inferences;
                stroke.Record();
                yield return AfterSeconds;
                facts = new PauseFacts(true, pausedSeconds, Haptics.IsReady && Haptics.Problem == null,
                    stroke.Blocks.Blocks, stroke.Statistics.Inferences - segments);
            }
            facts.AddTo(Report.Lines);
            EndStroke();
        }

        private IEnumerator Ask()
        {
            for (int index = 0; index < FeltQuestions.All.Count; ++index)
            {
                Instruction = $"Stroke the plates as long as you like. {FeltQuestions.All[index].Question}\n" +
                    "Yes: Y or button A or X. No: N or button B or Y. Skip: S.";
                answer = null;
                hasSkipped = false;
                IsAsking = true;
                while (answer == null && !hasSkipped)
                {
                    yield return null;
                }
                IsAsking = false;
                Report.Lines.Add(FeltQuestions.Line(index, answer));
            }
        }

        private static double Now => Time.realtimeSinceStartupAsDouble;

        private static void Add(HapticStylus stylus, StylusProbe probe, bool isPressing, double frameSeconds)
        {
            bool isTracked = stylus.isActiveAndEnabled;
            Transform tip = stylus.Tip != null ? stylus.Tip : stylus.transform;
            float? force = null;
            if (isTracked && stylus.Force != null && stylus.Force.TryMeasure(out float newtons))
            {
                force = newtons;
            }
            probe.Add(isPressing, frameSeconds, isTracked ? tip.position.ToDouble() : (Double3?)null, force);
        }

        private void EndStroke()
        {
            stroke?.Dispose();
            stroke = null;
        }

        private void Finish()
        {
            IsFinished = true;
            string folder = Folder ?? Path.Combine(Application.persistentDataPath, "HaptoFlow");
            try
            {
                PagePath = Report.Write(folder);
                Instruction = $"Finished: {Report.Summary}.\n{PagePath}\n{DeviceCheckReport.WhereToSend}";
                Debug.Log("HaptoFlow: the device check is finished: " + Instruction, this);
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                Instruction = $"Finished: {Report.Summary}.\nThe files could not be written: {error.Message}";
                Debug.LogError($"HaptoFlow: the device check's files could not be written: {error.Message}", this);
            }
        }

        /// <summary>Twelve seconds of noise, as a recording: only so that learning begins.</summary>
        private static Recordings.Recording Noise()
        {
            const int RateHz = 2000;
            var random = new Random(1);
            var table = new StringBuilder("time_s,acceleration_mps2\n");
            for (int index = 0; index < 12 * RateHz; ++index)
            {
                table.Append(FormattableString.Invariant(
                    $"{(double)index / RateHz:0.0000},{2.0 * random.NextDouble() - 1.0:0.0000}\n"));
            }
            return Recordings.RecordingReader.Read("noise.csv", new Dictionary<string, byte[]>
            {
                ["noise.csv"] = Encoding.UTF8.GetBytes(table.ToString()),
            }).With(0.1, 0.5);
        }

        private static IReadOnlyList<(string Name, string Value)> Surroundings() => new[]
        {
            ("package", LibraryAgreement.Version), ("Unity", Application.unityVersion),
            ("platform", Application.platform.ToString()), ("scripting backend", Backend),
            ("device", SystemInfo.deviceModel), ("system", SystemInfo.operatingSystem),
            ("processor", SystemInfo.processorType),
            ("date", DateTime.UtcNow.ToString("yyyy-MM-dd HH:mm 'UTC'", CultureInfo.InvariantCulture)),
        };

#if ENABLE_IL2CPP
        private const string Backend = "IL2CPP";
#elif ENABLE_MONO
        private const string Backend = "Mono";
#else
        private const string Backend = "unknown";
#endif
    }
}
