#nullable enable
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Threading;

namespace HaptoFlow
{
    /// <summary>Plays a made-up stroke on an engine at the pace of an audio device, into nothing, and reads by how much
    /// its segments lead.</summary>
    internal sealed class DelayProbe
    {
        // More than the segments whose distances the engine remembers.
        private const int Segments = 160;
        private const double MostSeconds = 10.0;

        // The engine guesses before it has seen some.
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
            this.updateRateHz = updateRateHz > 0.0 ? updateRateHz : 72.0;
            this.hasWorker = hasWorker;
        }

        /// <summary>Takes a few seconds. A thread of its own.</summary>
        /// <exception cref="HaptoFlowException">The engine gives no voice.</exception>
        /// <exception cref="OperationCanceledException">It was cancelled.</exception>
        public HapticModelDelay Measure(CancellationToken cancelled)
        {
            using HapticVoice voice = engine.OpenVoice(sampleRateHz);
            var block = new float[blockFrames];
            var leads = new List<uint>();
            var clock = Stopwatch.StartNew();
            double publishSeconds = 0.0;
            double renderSeconds = 0.0;
            VoiceStatistics statistics = default;
            while (statistics.Inferences < Segments && clock.Elapsed.TotalSeconds < MostSeconds)
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
                // A sleep may take 15 ms, longer than a block.
                Thread.Yield();
            }
            // A stall of this machine lengthens the lead for a while; half of the time it was no longer than this.
            leads.Sort();
            uint lead = leads.Count > 0 ? leads[leads.Count / 2] : statistics.LeadSamples;
            double leadMilliseconds = 0.5 * lead;
            // The voice closes with a block; somebody has to render it.
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
