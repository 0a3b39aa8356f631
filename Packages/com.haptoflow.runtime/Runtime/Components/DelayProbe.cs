#nullable enable
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Threading;

namespace HaptoFlow
{
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
