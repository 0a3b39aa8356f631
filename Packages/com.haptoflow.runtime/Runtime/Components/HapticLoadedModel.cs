#nullable enable
using System;
using System.Collections.Generic;
using System.Threading.Tasks;

namespace HaptoFlow
{
    /// <summary>A model that is loaded beside the one in use, so that it can take over from one frame to the next: see
    /// <see cref="Haptics.Load"/>. It costs the memory of an engine, and no time while nobody uses it. Main thread.
    /// </summary>
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

        /// <summary>It is loaded and can be used.</summary>
        public bool IsReady
        {
            get
            {
                session.Poll();
                return session.Engine != null;
            }
        }

        /// <summary>Why it cannot be used; null while it is being loaded, and where nothing is wrong.</summary>
        public string? Problem
        {
            get
            {
                session.Poll();
                return session.IsClosed ? "the model was closed" : session.Problem;
            }
        }

        /// <summary>Styluses feel by this model.</summary>
        public bool IsInUse => !session.IsClosed && ReferenceEquals(HapticSession.Existing, session);

        /// <summary>Names of the model's labels; empty before it is ready.</summary>
        public IReadOnlyList<string> Labels => session.Labels.All;

        /// <summary>Name of the tier that generates; empty before the model is ready. Makes garbage.</summary>
        public string TierName => session.Engine == null
            ? ""
            : Model.Header.Tiers[(int)session.Engine.Statistics().Tier].Name;

        /// <summary>Styluses feel by this model from their next update on. What sounds meanwhile fades within a block
        /// and 5 ms while the new model begins, so that nothing clicks; nothing is loaded, and nobody waits. An output
        /// by the mixer effect has one voice at a time: there, change while nothing is touched.</summary>
        /// <exception cref="InvalidOperationException">The model is not ready.</exception>
        public void Use()
        {
            if (!IsReady)
            {
                throw new InvalidOperationException(
                    "HaptoFlow: a loaded model is used when it is ready: " + (Problem ?? "it is still being loaded"));
            }
            session.Use();
        }

        /// <summary>Has a learnt material registered before it is touched, by another thread.</summary>
        /// <param name="refusal">Why the model cannot make it felt as it was learnt; null where nothing is wrong yet.
        /// </param>
        /// <returns>It is felt as it was learnt. False also while it is being registered.</returns>
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

        /// <summary>Measures by how much this model's sound comes after the motion, with a voice that nobody hears: a
        /// few seconds of one core. The audio device should play as it will later; nothing should be touched meanwhile.
        /// </summary>
        /// <param name="sampleRateHz">Of the audio device.</param>
        /// <param name="blockFrames">Of the audio device.</param>
        /// <returns>Fails with a <see cref="HaptoFlowException"/> where no voice is free, and is cancelled where the
        /// model is closed.</returns>
        /// <exception cref="InvalidOperationException">The model is not ready.</exception>
        public Task<HapticModelDelay> MeasureDelay(int sampleRateHz, int blockFrames)
        {
            if (!IsReady)
            {
                throw new InvalidOperationException("HaptoFlow: a loaded model is measured when it is ready");
            }
            return session.MeasureDelay(sampleRateHz, blockFrames);
        }

        /// <summary>Closes the model's engine. Where it is in use, the model of the settings takes over.</summary>
        public void Dispose() => session.Unload();

        /// <summary>Waits until loading has ended, well or not.</summary>
        internal void FinishLoading() => session.FinishLoading();
    }
}
