#nullable enable
using System;
using System.Collections.Generic;
using System.Threading.Tasks;

namespace HaptoFlow
{
    /// <summary>A model loaded in addition to the one in use, so that it can replace it between two frames: see <see
    /// cref="Haptics.Load"/>. It costs the memory of an engine, and no time while it is not in use. Main
    /// thread.</summary>
    public sealed class HapticLoadedModel : IDisposable
    {
        private readonly HapticSession session;

        internal HapticLoadedModel(HapticModelAsset model, HapticQuality quality)
        {
            if (model == null)
            {
                throw new ArgumentNullException(nameof(model));
            }
            Model = model;
            session = HapticSession.Load(model, quality);
        }

        /// <summary>The asset that was loaded.</summary>
        public HapticModelAsset Model { get; }

        /// <summary>True when the model is loaded and can be used.</summary>
        public bool IsReady
        {
            get
            {
                session.Poll();
                return session.Engine != null;
            }
        }

        /// <summary>Why the model cannot be used; null while it loads and where there is no error.</summary>
        public string? Problem
        {
            get
            {
                session.Poll();
                return session.IsClosed ? "the model was closed" : session.Problem;
            }
        }

        /// <summary>True while styluses use this model.</summary>
        public bool IsInUse => !session.IsClosed && ReferenceEquals(HapticSession.Existing, session);

        /// <summary>Names of the model's labels; empty until the model is ready.</summary>
        public IReadOnlyList<string> Labels => session.Labels.All;

        /// <summary>Name of the tier in use; empty until the model is ready. Makes garbage.</summary>
        public string TierName => session.Engine == null
            ? ""
            : Model.Header.Tiers[(int)session.Engine.Statistics().Tier].Name;

        /// <summary>Makes styluses use this model from their next update. The old voices fade within a block and 5 ms
        /// while the new ones begin, so nothing clicks; nothing is loaded and the call does not wait. The mixer effect
        /// has one voice at a time: with it, change models while nothing is touched.</summary>
        /// <exception cref="InvalidOperationException">The model is not ready.</exception>
        public void Use()
        {
            if (!IsReady)
            {
                throw new InvalidOperationException(
                    "HaptoFlow: a loaded model can be used only when it is ready: " + (Problem ?? "it is still " +
                        "being loaded"));
            }
            session.Use();
        }

        /// <summary>Registers a learnt material on another thread before it is touched.</summary>
        /// <param name="refusal">Why the engine refused the material; null where it did not.</param>
        /// <returns>True when the material is registered. False also while registration is under way.</returns>
        public bool TryPrepare(HapticMaterial material, out string? refusal)
        {
            refusal = null;
            if (!IsReady || !material.IsLearnt)
            {
                return false;
            }
            bool isFelt = session.Learnt!.TryFind(material, out _, out _);
            refusal = session.Learnt.WhyRefused(material);
            return isFelt;
        }

        /// <summary>Measures the lead of this model with a voice that is not played. Takes a few seconds of one core.
        /// Run it with the audio device in its final state and while nothing is touched.</summary>
        /// <param name="sampleRateHz">Sample rate of the audio device.</param>
        /// <param name="blockFrames">Block size of the audio device.</param>
        /// <returns>A task that fails with a <see cref="HaptoFlowException"/> where no voice is free, and is cancelled
        /// when the model is closed.</returns>
        /// <exception cref="InvalidOperationException">The model is not ready.</exception>
        public Task<HapticModelDelay> MeasureDelay(int sampleRateHz, int blockFrames)
        {
            if (!IsReady)
            {
                throw new InvalidOperationException("HaptoFlow: a loaded model can be measured only when it is ready");
            }
            return session.MeasureDelay(sampleRateHz, blockFrames);
        }

        /// <summary>Closes the model's engine. If it is in use, styluses return to the model of the settings.</summary>
        public void Dispose() => session.Unload();

        /// <summary>Waits until loading has succeeded or failed.</summary>
        internal void FinishLoading() => session.FinishLoading();
    }
}
