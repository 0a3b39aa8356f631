#nullable enable
using System;
using System.Collections.Generic;
using System.Threading;
using System.Threading.Tasks;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>An engine of the running application. The one of the settings is loaded in the background when the
    /// first stylus is enabled; others can be loaded in addition, and one of them can replace it. All are closed when
    /// the application quits. Main thread unless a member says otherwise.</summary>
    internal sealed class HapticSession
    {
        private static readonly List<HapticSession> AdditionalSessions = new List<HapticSession>();
        private static HapticSession? settingsSession;
        private static HapticSession? replacingSession;
        private static int lastLabelsVersion;

        private readonly Task<(HapticEngine Engine, ModelLabels Labels, string Space)> loading;
        private readonly HapticCancellation? cancellation;
        private readonly CancellationTokenSource closing = new CancellationTokenSource();
        private readonly EngineHealth health = new EngineHealth();
        private readonly bool isAdditional;
        private readonly byte[]? modelFile;
        private Task<HapticModelDelay>? measuring;
        private bool reported;

        private HapticSession(
            HaptoFlowSettings settings, HapticModelAsset? model, HapticQuality quality, bool isAdditional)
        {
            LabelsVersion = ++lastLabelsVersion;
            Settings = settings;
            this.isAdditional = isAdditional;
            if (model == null)
            {
                loading = Task.FromException<(HapticEngine, ModelLabels, string)>(new HaptoFlowException(
                    HaptoFlowStatus.InvalidArgument,
                    "no model is chosen: choose one in Project Settings > HaptoFlow, or set HaptoFlowSettings.Active"));
                return;
            }
            byte[] file = model.File;
            modelFile = file;
            HapticEngineOptions options = OptionsOf(settings);
            // Auto is chosen by what the worker measures, and refused without one.
            options.Quality = options.WithoutWorker && quality == HapticQuality.Auto ? HapticQuality.Draft : quality;
            UpdateRateHz = options.UpdateRateHz;
            HasWorker = !options.WithoutWorker;
            cancellation = NewCancellation();
            options.Cancellation = cancellation;
            loading = Task.Run(() => Load(file, options));
        }

        /// <summary>The session in use; starts that of the settings where there is none, and again where it failed and
        /// another model is there.</summary>
        public static HapticSession Current
        {
            get
            {
                if (replacingSession == null && settingsSession?.CanSucceedNow() == true)
                {
                    Restart();
                }
                return replacingSession ?? (settingsSession ??= NewSettingsSession());
            }
        }

        /// <summary>Null until the first stylus is enabled.</summary>
        public static HapticSession? Existing => replacingSession ?? settingsSession;

        /// <summary>Options of engines without worker threads, for rendering and tests that step them outside real
        /// time; null in applications.</summary>
        public static HapticEngineOptions? OptionsOverride { get; set; }

        public HaptoFlowSettings Settings { get; }

        public double UpdateRateHz { get; }

        public bool HasWorker { get; }

        /// <summary>True after the session was closed by its owner or by the end of the application.</summary>
        public bool IsClosed { get; private set; }

        /// <summary>Changes whenever the indices of labels may have changed.</summary>
        public int LabelsVersion { get; private set; }

        /// <summary>Null while loading, and where loading failed.</summary>
        public HapticEngine? Engine { get; private set; }

        public ModelLabels Labels { get; private set; } = new ModelLabels(Array.Empty<HapticLabel>());

        public string? Problem { get; private set; }

        public LearntMaterials? Learnt => Labels.Learnt;

        /// <summary>Takes over the result of loading once it is complete. Call once a frame; no garbage when nothing
        /// changed.</summary>
        public void Poll()
        {
            if (reported)
            {
                CheckRunningEngine();
                return;
            }
            if (!loading.IsCompleted)
            {
                return;
            }
            reported = true;
            if (loading.Status == TaskStatus.RanToCompletion)
            {
                Engine = loading.Result.Engine;
                Labels = loading.Result.Labels;
                Labels.Learnt = new LearntMaterials(Engine, loading.Result.Space, Labels.All.Count);
                LabelsVersion = ++lastLabelsVersion;
                SurfaceRegistry.PrepareAll(this);
                MaterialMaps.PrepareAll(this);
                return;
            }
            Exception cause = loading.Exception!.GetBaseException();
            Problem = cause.Message;
            // The owner of an additional model reads its Problem; the scene keeps its haptics.
            if (!isAdditional)
            {
                Debug.LogError($"HaptoFlow: the scene runs without haptics: {cause.Message}");
            }
        }

        public static HapticSession Load(HapticModelAsset model, HapticQuality quality)
        {
            var session = new HapticSession(HaptoFlowSettings.Active, model, quality, true);
            AdditionalSessions.Add(session);
            return session;
        }

        /// <summary>Makes styluses use this session instead of that of the settings.</summary>
        public void Use()
        {
            replacingSession = this;
            SurfaceRegistry.PrepareAll(this);
            MaterialMaps.PrepareAll(this);
        }

        public static void UseSettings() => replacingSession = null;

        /// <summary>Closes a session that was loaded in addition to that of the settings.</summary>
        public void Unload()
        {
            if (AdditionalSessions.Remove(this))
            {
                if (ReferenceEquals(replacingSession, this))
                {
                    replacingSession = null;
                }
                Close();
            }
        }

        public void SetQuality(HapticQuality quality)
        {
            try
            {
                Engine?.SetQuality(quality);
            }
            catch (HaptoFlowException refusal)
            {
                Debug.LogWarning($"HaptoFlow: the quality was not changed: {refusal.Message}");
            }
        }

        /// <summary>Registers the learnt material of a description before it is touched.</summary>
        public void Prepare(MaterialDescription description)
        {
            HapticMaterial? material = description.Learnt;
            if (material != null)
            {
                Learnt?.TryFind(material, out _, out _);
            }
        }

        /// <summary>Gives a relief to the native library before it is touched.</summary>
        public void Prepare(HapticRelief? relief)
        {
            if (relief != null && Engine != null)
            {
                _ = relief.Number;
            }
        }

        public void FinishRegistrations()
        {
            Learnt?.Finish();
            LabelsVersion = ++lastLabelsVersion;
        }

        /// <summary>Measures this engine's lead on another thread. A second call during the measurement returns the
        /// same task.</summary>
        public Task<HapticModelDelay> MeasureDelay(int sampleRateHz, int blockFrames)
        {
            if (measuring == null || measuring.IsCompleted)
            {
                var probe = new DelayProbe(Engine!, sampleRateHz, blockFrames, UpdateRateHz, HasWorker);
                measuring = Task.Run(() => probe.Measure(closing.Token));
            }
            return measuring;
        }

        public void FinishLoading()
        {
            ((IAsyncResult)loading).AsyncWaitHandle.WaitOne();
            Poll();
        }

        /// <summary>Has every engine register the new text of a material, or remove one that has none or was
        /// destroyed; labels of its users are then looked up again.</summary>
        public static void OnMaterialChanged(HapticMaterial material, bool isGone)
        {
            settingsSession?.ChangeLearnt(material, isGone);
            AdditionalSessions.ForEach(each => each.ChangeLearnt(material, isGone));
        }

        private void ChangeLearnt(HapticMaterial material, bool isGone)
        {
            if (!isGone)
            {
                Learnt?.Change(material);
            }
            else if (Learnt?.Forget(material) == true)
            {
                LabelsVersion = ++lastLabelsVersion;
            }
        }

        /// <summary>Closes the engine of the settings and leaves the additional ones open. The next stylus starts it
        /// again.</summary>
        public static void Restart()
        {
            HapticSession? ending = settingsSession;
            settingsSession = null;
            replacingSession = null;
            ending?.Close();
        }

        /// <summary>Closes every engine. The next stylus starts that of the settings again.</summary>
        public static void ShutDown()
        {
            Restart();
            HapticSession[] ending = AdditionalSessions.ToArray();
            AdditionalSessions.Clear();
            Array.ForEach(ending, each => each.Close());
        }

        private static HapticSession NewSettingsSession()
        {
            HaptoFlowSettings settings = HaptoFlowSettings.Active;
            return new HapticSession(settings, settings.Model, settings.Quality, false);
        }

        private bool CanSucceedNow()
        {
            if (!reported || Engine != null)
            {
                return false;
            }
            HapticModelAsset? model = HaptoFlowSettings.Active.Model;
            return model != null && !ReferenceEquals(model.File, modelFile);
        }

        /// <summary>Cancels loading and waits for it: native code must not run on when the process or the application
        /// domain ends.</summary>
        private void Close()
        {
            IsClosed = true;
            cancellation?.Cancel();
            closing.Cancel();
            Task.WhenAny(measuring ?? Task.CompletedTask).GetAwaiter().GetResult();
            Learnt?.Close();
            ((IAsyncResult)loading).AsyncWaitHandle.WaitOne();
            if (loading.Status == TaskStatus.RanToCompletion)
            {
                loading.Result.Engine.Dispose();
            }
            Engine = null;
            Labels.Learnt = null;
            // A cancelled loading is not an error to report.
            reported = true;
            cancellation?.Dispose();
            closing.Dispose();
        }

        private void CheckRunningEngine()
        {
            if (Engine == null)
            {
                return;
            }
            if (Learnt!.Poll())
            {
                LabelsVersion = ++lastLabelsVersion;
            }
            // The worker of an engine that is not in use is checked when it is used.
            string? workerFailure = ReferenceEquals(this, Existing)
                ? health.Check(Time.unscaledTimeAsDouble, Engine)
                : null;
            if (workerFailure != null)
            {
                Problem = workerFailure;
                Debug.LogError($"HaptoFlow: haptics have stopped: {workerFailure}");
            }
        }

        private static HapticCancellation? NewCancellation()
        {
            try
            {
                return new HapticCancellation();
            }
            catch (HaptoFlowException)
            {
                return null;
            }
        }

        private static HapticEngineOptions OptionsOf(HaptoFlowSettings settings)
        {
            HapticEngineOptions options = OptionsOverride ?? default;
            options.BudgetShare = settings.BudgetShare;
            options.UpdateRateHz = settings.FollowDisplay && DisplayRate.TryGet(out double displayHz)
                ? displayHz
                : settings.UpdateRateHz;
            options.FullScaleMps2 = settings.FullScaleMps2;
            return options;
        }

        private static (HapticEngine Engine, ModelLabels Labels, string Space) Load(
            byte[] file, HapticEngineOptions options)
        {
            using OnnxRuntime runtime = OnnxRuntime.Open();
            using HapticModel model = HapticModel.Open(file);
            return (new HapticEngine(runtime, model, options), new ModelLabels(model.Labels), model.Space);
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void OnSubsystemRegistration()
        {
            ShutDown();
            Application.quitting -= ShutDown;
            Application.quitting += ShutDown;
            Application.quitting -= HapticLearning.EndAll;
            Application.quitting += HapticLearning.EndAll;
        }
    }

    /// <summary>Checks once a second that an engine's worker thread is alive. Main thread; no garbage while it
    /// is.</summary>
    internal sealed class EngineHealth
    {
        private const double PeriodSeconds = 1.0;

        private double nextSeconds = double.NegativeInfinity;
        private bool reported;

        /// <summary>The message for a worker that has ended, returned once; null otherwise.</summary>
        public string? Check(double nowSeconds, HapticEngine engine)
        {
            if (reported || nowSeconds < nextSeconds)
            {
                return null;
            }
            nextSeconds = nowSeconds + PeriodSeconds;
            EngineStatistics statistics = engine.Statistics();
            return MessageFor(statistics, statistics.WorkerIsAlive ? "" : engine.LastFailure());
        }

        /// <summary>The message for statistics of a worker that has ended, returned once; null otherwise.</summary>
        internal string? MessageFor(in EngineStatistics statistics, string lastFailure)
        {
            if (reported || statistics.WorkerIsAlive)
            {
                return null;
            }
            reported = true;
            string cause = lastFailure.Length > 0 ? $" ({lastFailure})" : "";
            return $"the engine's worker thread has ended{cause}; call Haptics.Restart";
        }
    }
}
