#nullable enable
using System.Globalization;

namespace HaptoFlow.Editor
{
    /// <summary>The state of an output in play mode: times, underruns, and the engine that feeds it.</summary>
    internal sealed class OutputReadout : Readout<HapticOutput>
    {
        private int voices;
        private ulong underruns;
        private ulong limited;

        protected override void Read(HapticOutput output)
        {
            voices = 0;
            underruns = 0;
            limited = 0;
            output.ForEachVoice((voice, readout) => readout.Count(voice), this);
            Add("Voices", "{0}", voices);
            Add("Underruns", "{0}", underruns);
            Add("Limited samples", "{0}", limited);
            if (output.Route != OutputRoute.MixerEffect)
            {
                Add("Rendering a block", "{0:0.000} ms, at worst {1:0.000} ms",
                    output.RenderMilliseconds, output.WorstRenderMilliseconds);
            }
            Add("Device", "{0} Hz", output.SampleRateHz);
            if (Haptics.TryGetStatistics(out EngineStatistics engine))
            {
                Add("Inference", "{0:0.00} ms a round, budget {1:0.00} ms", engine.LastRoundMs, engine.BudgetMs);
                Add("Quality", TierOf(engine));
                AddHealth(engine);
            }
        }

        private void AddHealth(in EngineStatistics engine)
        {
            if (!engine.WorkerIsAlive)
            {
                Add("Worker", "has ended; Haptics.Restart starts it again");
            }
            if (engine.PriorityWasRefused)
            {
                Add("Worker priority", "refused by the system, so more segments are late");
            }
            string failure = engine.FailedRounds > 0 || !engine.WorkerIsAlive ? Haptics.LastFailure : "";
            if (failure.Length > 0)
            {
                Add("Last failure", failure);
            }
        }

        private void Count(HapticVoice voice)
        {
            VoiceStatistics statistics = voice.Statistics();
            ++voices;
            underruns += statistics.Underruns;
            limited += statistics.LimitedSamples;
        }

        private static string TierOf(in EngineStatistics engine)
        {
            string tier = NameOf((int)engine.Tier);
            return engine.IsMeasuring ? tier + ", measuring" : tier;
        }

        private static string NameOf(int tier)
        {
            HapticModelAsset? model = HaptoFlowSettings.Active.Model;
            try
            {
                return model != null && tier < model.Header.Tiers.Count
                    ? model.Header.Tiers[tier].Name
                    : "tier " + tier.ToString(CultureInfo.InvariantCulture);
            }
            catch (HaptoFlowException)
            {
                // The settings now name a damaged model, while the engine still runs with the previous one.
                return "of the previous model";
            }
        }
    }
}
