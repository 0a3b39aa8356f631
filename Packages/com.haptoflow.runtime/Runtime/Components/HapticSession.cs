#nullable enable
using System;
using System.Collections.Generic;
using System.Threading;
using System.Threading.Tasks;
using HaptoFlow.Model;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>An engine of the running application. That of the settings is loaded in the background when the first
    /// stylus wakes; others are loaded beside it, and one of them may be in use in its place. All are closed when the
    /// application ends. Main thread, but for what says otherwise.</summary>
    internal sealed class HapticSession
    {
        private static readonly List<HapticSession> Beside = new List<HapticSession>();
        private static HapticSession? ofSettings;
        private static HapticSession? inPlaceOfSettings;
        private static int versions;

        private readonly Task<Loaded> loading;
        private readonly HapticCancellation? cancellation;
        private readonly CancellationTokenSource closing = new CancellationTokenSource();
        private readonly EngineHealth health = new EngineHealth();
        private QualityChange? qualityChange;
        private readonly bool isBeside;
        private Task<HapticModelDelay>? measuring;
        private bool reported;

        private HapticSession(
            HaptoFlowSettings settings, HapticModelAsset? model, HapticQuality quality, bool isBeside)
        {
            LabelsVersion = ++versions;
            Settings = settings;
            this.isBeside = isBeside;
            if (model == null)
            {
                loading = Task.FromException<Loaded>(new HaptoFlowException(HaptoFlowStatus.InvalidArgument,
                    "no model is chosen: choose one in Project Settings > HaptoFlow, or set HaptoFlowSettings.Active"));
                return;
            }
            byte[] file = model.File;
            HapticEngineOptions options = OptionsOf(settings);
            options.Quality = quality;
            UpdateRateHz = options.UpdateRateHz;
            HasWorker = !options.WithoutWorker;
            cancellation = NewCancellation();
            options.Cancellation = cancellation;
            loading = Task.Run(() => Load(file, options));
        }

        /// <summary>The session in use; starts that of the settings where there is none.</summary>
        public static HapticSession Current => inPlaceOfSettings ?? (ofSettings ??= OfSettings());

        /// <summary>Null where no stylus has woken yet.</summary>
        public static HapticSession? Existing => inPlaceOfSettings ?? ofSettings;

        /// <summary>Of engines without worker, for whoever steps them: rendering and tests outside of real
        /// time.</summary>
        public static HapticEngineOptions? OptionsInstead { get; set; }

        public HaptoFlowSettings Settings { get; }

        /// <summary>Contact states a second that the engine was told to expect.</summary>
        public double UpdateRateHz { get; }

        /// <summary>The engine generates by itself; without a worker somebody has to step it.</summary>
        public bool HasWorker { get; }

        /// <summary>It was closed: by whoever loaded it, or because the application ends.</summary>
        public bool IsClosed { get; private set; }

        /// <summary>Another number whenever the labels may be others.</summary>
        public int LabelsVersion { get; private set; }

        /// <summary>Null while loading, and where loading failed.</summary>
        public HapticEngine? Engine { get; private set; }

        /// <summary>Empty while loading, and where loading failed.</summary>
        public ModelLabels Labels { get; private set; } = new ModelLabels(Array.Empty<ModelLabel>());

        /// <summary>Why there are no haptics; null where nothing is wrong.</summary>
        public string? Problem { get; private set; }

        /// <summary>Null while loading, and where loading failed.</summary>
        public LearntMaterials? Learnt => Labels.Learnt;

        /// <summary>Takes over what was loaded meanwhile. Once a frame; no garbage when nothing happened.</summary>
        public void Poll()
        {
            if (reported)
            {
                Watch();
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
                LabelsVersion = ++versions;
                SurfaceRegistry.PrepareAll(this);
                MaterialMaps.PrepareAll(this);
                return;
            }
            Exception cause = loading.Exception!.GetBaseException();
            Problem = cause.Message;
            // Whoever loads a model beside the one in use is told by its Problem, and the scene keeps its haptics.
            if (!isBeside)
            {
                Debug.LogError($"HaptoFlow: the scene goes on without haptics: {cause.Message}");
            }
        }

        /// <summary>Loads a model beside the one in use.</summary>
        public static HapticSession Load(HapticModelAsset model, HapticQuality quality)
        {
            var session = new HapticSession(HaptoFlowSettings.Active, model, quality, true);
            Beside.Add(session);
            return session;
        }

        /// <summary>From now on styluses feel by this session, in the place of that of the settings.</summary>
        public void Use()
        {
            inPlaceOfSettings = this;
            SurfaceRegistry.PrepareAll(this);
            MaterialMaps.PrepareAll(this);
        }

        /// <summary>From now on styluses feel by the session of the settings.</summary>
        public static void UseSettings() => inPlaceOfSettings = null;

        /// <summary>Closes a session that was loaded beside the one of the settings.</summary>
        public void Unload()
        {
            if (Beside.Remove(this))
            {
                if (ReferenceEquals(inPlaceOfSettings, this))
                {
                    inPlaceOfSettings = null;
                }
                Close();
            }
        }

        /// <summary>Changes the quality of a running engine. A tier that has to be loaded first is loaded by another
        /// thread.</summary>
        public void SetQuality(HapticQuality quality)
        {
            if (Engine != null)
            {
                qualityChange = new QualityChange(Engine, quality, qualityChange);
            }
        }

        /// <summary>Waits until the quality that was asked for last is there, or was refused.</summary>
        public void FinishQualityChange() => qualityChange?.Finish();

        /// <summary>Has what a description needs registered before it is touched.</summary>
        public void Prepare(MaterialDescription description)
        {
            HapticMaterial? material = description.Learnt;
            if (material != null)
            {
                Learnt?.TryFind(material, out _, out _);
            }
        }

        /// <summary>A material may carry another text, or none.</summary>
        private void ChangeLearnt(HapticMaterial material)
        {
            if (!material.IsLearnt)
            {
                ForgetLearnt(material);
            }
            else
            {
                Learnt?.Change(material);
            }
        }

        /// <summary>A material is gone: whoever is made of it is looked up again.</summary>
        private void ForgetLearnt(HapticMaterial material)
        {
            if (Learnt?.Forget(material) == true)
            {
                LabelsVersion = ++versions;
            }
        }

        /// <summary>Waits until all materials that were asked for are registered, or were refused.</summary>
        public void FinishRegistrations()
        {
            Learnt?.Finish();
            LabelsVersion = ++versions;
        }

        /// <summary>Has another thread measure by how much this engine's sound comes after the motion. A second call
        /// while it measures returns what is under way.</summary>
        public Task<HapticModelDelay> MeasureDelay(int sampleRateHz, int blockFrames)
        {
            if (measuring == null || measuring.IsCompleted)
            {
                var probe = new DelayProbe(Engine!, sampleRateHz, blockFrames, UpdateRateHz, HasWorker);
                measuring = Task.Run(() => probe.Measure(closing.Token));
            }
            return measuring;
        }

        /// <summary>Waits until loading has ended, well or not.</summary>
        public void FinishLoading()
        {
            ((IAsyncResult)loading).AsyncWaitHandle.WaitOne();
            Poll();
        }

        /// <summary>A material may carry another text, or none: every engine is told.</summary>
        public static void TellOfChange(HapticMaterial material)
        {
            ofSettings?.ChangeLearnt(material);
            foreach (HapticSession each in Beside)
            {
                each.ChangeLearnt(material);
            }
        }

        /// <summary>A material is gone: every engine is told.</summary>
        public static void TellOfEnd(HapticMaterial material)
        {
            ofSettings?.ForgetLearnt(material);
            foreach (HapticSession each in Beside)
            {
                each.ForgetLearnt(material);
            }
        }

        /// <summary>Closes the engine of the settings and leaves those that were loaded beside it. The next stylus that
        /// asks starts it anew.</summary>
        public static void Restart()
        {
            HapticSession? ending = ofSettings;
            ofSettings = null;
            inPlaceOfSettings = null;
            ending?.Close();
        }

        /// <summary>Closes every engine. The next stylus that asks starts anew.</summary>
        public static void ShutDown()
        {
            Restart();
            HapticSession[] ending = Beside.ToArray();
            Beside.Clear();
            Array.ForEach(ending, each => each.Close());
        }

        private static HapticSession OfSettings()
        {
            HaptoFlowSettings settings = HaptoFlowSettings.Active;
            return new HapticSession(settings, settings.Model, settings.Quality, false);
        }

        /// <summary>Ends a loading that is under way and waits for it: a process or an application domain must not end
        /// beneath it.</summary>
        private void Close()
        {
            IsClosed = true;
            cancellation?.Cancel();
            closing.Cancel();
            Task.WhenAny(measuring ?? Task.CompletedTask).GetAwaiter().GetResult();
            qualityChange?.Finish();
            Learnt?.Close();
            ((IAsyncResult)loading).AsyncWaitHandle.WaitOne();
            if (loading.Status == TaskStatus.RanToCompletion)
            {
                loading.Result.Engine.Dispose();
            }
            Engine = null;
            Labels.Learnt = null;
            // Nobody is left to be told of a loading that was cancelled.
            reported = true;
            cancellation?.Dispose();
            closing.Dispose();
        }

        private void Watch()
        {
            if (Engine == null)
            {
                return;
            }
            if (Learnt!.Poll())
            {
                LabelsVersion = ++versions;
            }
            string? failure = qualityChange?.TakeFailure();
            if (failure != null)
            {
                Debug.LogWarning($"HaptoFlow: the quality stays as it was: {failure}");
            }
            // An engine that nobody feels is looked at when it is used.
            string? death = ReferenceEquals(this, Existing)
                ? health.Examine(Time.unscaledTimeAsDouble, Engine)
                : null;
            if (death != null)
            {
                Problem = death;
                Debug.LogError($"HaptoFlow: nothing is felt from now on: {death}");
            }
        }

        /// <summary>Null where there is no native library: loading says so.</summary>
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
            HapticEngineOptions options = OptionsInstead ?? default;
            options.BudgetShare = settings.BudgetShare;
            options.UpdateRateHz = settings.FollowDisplay && DisplayRate.TryGet(out double displayHz)
                ? displayHz
                : settings.UpdateRateHz;
            options.FullScaleMps2 = settings.FullScaleMps2;
            return options;
        }

        private static Loaded Load(byte[] file, HapticEngineOptions options)
        {
            using OnnxRuntime runtime = OnnxRuntime.Open();
            using HapticModel model = HapticModel.Open(file);
            var labels = new ModelLabels(ModelHeader.Read(file).Labels);
            return new Loaded(new HapticEngine(runtime, model, options), labels, ModelSpace.Of(file).Id);
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Begin()
        {
            ShutDown();
            Application.quitting -= ShutDown;
            Application.quitting += ShutDown;
            Application.quitting -= HapticLearning.EndAll;
            Application.quitting += HapticLearning.EndAll;
        }

        private sealed class Loaded
        {
            public Loaded(HapticEngine engine, ModelLabels labels, string space)
            {
                Engine = engine;
                Labels = labels;
                Space = space;
            }

            public HapticEngine Engine { get; }

            public ModelLabels Labels { get; }

            public string Space { get; }
        }
    }
}
