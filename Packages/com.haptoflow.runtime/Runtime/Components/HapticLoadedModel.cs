#nullable enable
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Threading;
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

        internal void FinishLoading() => session.FinishLoading();
    }

    /// <summary>The delay between motion and sound that a model causes on this machine, measured with a voice that is
    /// not played.</summary>
    public readonly struct HapticModelDelay
    {
        internal HapticModelDelay(double leadMilliseconds, in TierTimes inference)
        {
            LeadMilliseconds = leadMilliseconds;
            InferenceMedianMilliseconds = inference.MedianMs;
            InferencePercentile99Milliseconds = inference.Percentile99Ms;
            Runs = inference.Runs;
        }

        /// <summary>Time from a contact state to the first sample generated from it: inference and the audio blocks
        /// that pass meanwhile. The device's buffer, the amplifier and the actuator add to it.</summary>
        public double LeadMilliseconds { get; }

        /// <summary>Median time of an inference.</summary>
        public double InferenceMedianMilliseconds { get; }

        /// <summary>99th percentile of the time of an inference.</summary>
        public double InferencePercentile99Milliseconds { get; }

        /// <summary>Number of inferences measured.</summary>
        public ulong Runs { get; }
    }

    /// <summary>Measures the lead of an engine's segments: feeds it a synthetic stroke in real time, in blocks of the
    /// audio device's size, and discards the samples.</summary>
    internal sealed class DelayProbe
    {
        // More segments than the engine's statistics of inference times cover.
        private const int Segments = 160;
        private const double MaximumSeconds = 10.0;

        // Leads before this many segments are the engine's initial estimate, not measurements.
        private const int GuessedSegments = 16;
        private const float SpeedMps = 0.1f;
        private const float ForceNewtons = 0.5f;

        private readonly HapticEngine engine;
        private readonly int sampleRateHz;
        private readonly int blockFrames;
        private readonly double updateRateHz;
        private readonly bool hasWorker;

        public DelayProbe(
            HapticEngine engine, int sampleRateHz, int blockFrames, double updateRateHz, bool hasWorker)
        {
            this.engine = engine;
            this.sampleRateHz = sampleRateHz;
            this.blockFrames = Math.Max(1, blockFrames);
            this.updateRateHz = updateRateHz > 0.0 ? updateRateHz : HapticEngineOptions.DefaultUpdateRateHz;
            this.hasWorker = hasWorker;
        }

        /// <summary>Blocks for up to ten seconds: call it from a thread of its own.</summary>
        /// <exception cref="HaptoFlowException">No voice is free.</exception>
        /// <exception cref="OperationCanceledException"><paramref name="cancelled"/> was cancelled.</exception>
        public HapticModelDelay Measure(CancellationToken cancelled)
        {
            using HapticVoice voice = engine.OpenVoice(sampleRateHz);
            var block = new float[blockFrames];
            var leads = new List<uint>();
            var clock = Stopwatch.StartNew();
            double publishSeconds = 0.0;
            double renderSeconds = 0.0;
            VoiceStatistics statistics = default;
            while (statistics.Inferences < Segments && clock.Elapsed.TotalSeconds < MaximumSeconds)
            {
                cancelled.ThrowIfCancellationRequested();
                double now = clock.Elapsed.TotalSeconds;
                if (now >= publishSeconds)
                {
                    publishSeconds += 1.0 / updateRateHz;
                    voice.Publish(Sliding());
                    if (!hasWorker)
                    {
                        engine.Step();
                    }
                    statistics = voice.Statistics();
                    if (statistics.Inferences >= GuessedSegments)
                    {
                        leads.Add(statistics.LeadSamples);
                    }
                }
                if (now >= renderSeconds)
                {
                    renderSeconds += blockFrames / (double)sampleRateHz;
                    voice.Render(block, 1, 0, sampleRateHz);
                }
                // Thread.Sleep may take 15 ms, longer than a block.
                Thread.Yield();
            }
            // The median: a stall of this machine lengthens the lead of some segments.
            leads.Sort();
            uint lead = leads.Count > 0 ? leads[leads.Count / 2] : statistics.LeadSamples;
            double leadMilliseconds = 0.5 * lead;
            // A voice closes only after a further block was rendered.
            voice.SetMuted(true);
            voice.Render(block, 1, 0, sampleRateHz);
            return new HapticModelDelay(leadMilliseconds, engine.Times((int)engine.Statistics().Tier));
        }

        private static ContactState Sliding() => new ContactState
        {
            Touching = true,
            TouchCounter = 1,
            FirstVelocityMps = SpeedMps,
            ForceNewtons = ForceNewtons,
            Material = LabelBlend.Of(0),
            Effects = HapticEffects.Texture,
        };
    }
}
