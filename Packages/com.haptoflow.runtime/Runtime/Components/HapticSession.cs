#nullable enable
using System;
using System.Threading.Tasks;
using HaptoFlow.Model;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The engine of the running application: loaded in the background when the first stylus wakes, closed
    /// when
    /// the application ends. Main thread, but for what says otherwise.</summary>
    internal sealed class HapticSession
    {
        private static HapticSession? current;
        private static int versions;

        private readonly Task<Loaded> loading;
        private readonly HapticCancellation? cancellation;
        private readonly EngineHealth health = new EngineHealth();
        private QualityChange? qualityChange;
        private bool reported;

        private HapticSession(HaptoFlowSettings settings)
        {
            LabelsVersion = ++versions;
            Settings = settings;
            HapticModelAsset? model = settings.Model;
            if (model == null)
            {
                loading = Task.FromException<Loaded>(new HaptoFlowException(HaptoFlowStatus.InvalidArgument,
                    "no model is chosen: choose one in Project Settings > HaptoFlow, or set HaptoFlowSettings.Active"));
                return;
            }
            byte[] file = model.File;
            HapticEngineOptions options = OptionsOf(settings);
            cancellation = NewCancellation();
            options.Cancellation = cancellation;
            loading = Task.Run(() => Load(file, options));
        }

        /// <summary>The session; starts it where there is none.</summary>
        public static HapticSession Current => current ??= new HapticSession(HaptoFlowSettings.Active);

        /// <summary>Null where no stylus has woken yet.</summary>
        public static HapticSession? Existing => current;

        /// <summary>Of engines without worker, for whoever steps them: rendering and tests outside of real
        /// time.</summary>
        public static HapticEngineOptions? OptionsInstead { get; set; }

        public HaptoFlowSettings Settings { get; }

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
            Debug.LogError($"HaptoFlow: the scene goes on without haptics: {cause.Message}");
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
        public void ChangeLearnt(HapticMaterial material)
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
        public void ForgetLearnt(HapticMaterial material)
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

        /// <summary>Waits until loading has ended, well or not.</summary>
        public void FinishLoading()
        {
            ((IAsyncResult)loading).AsyncWaitHandle.WaitOne();
            Poll();
        }

        /// <summary>Closes the engine. The next stylus that asks starts anew.</summary>
        public static void ShutDown()
        {
            HapticSession? ending = current;
            current = null;
            ending?.Close();
        }

        /// <summary>Ends a loading that is under way and waits for it: a process or an application domain must not end
        /// beneath it.</summary>
        private void Close()
        {
            cancellation?.Cancel();
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
            string? death = health.Examine(Time.unscaledTimeAsDouble, Engine);
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
            options.Quality = settings.Quality;
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
