using System.Collections.Generic;
using System.Text.RegularExpressions;
using HaptoFlow.Model;
using HaptoFlow.Preview;

namespace HaptoFlow.PreviewTests
{
    /// <summary>A header with invented accuracy, and invented times.</summary>
    internal static class MeasuredModel
    {
        /// <summary>Matches the accuracy of a tier in a header.</summary>
        public static readonly Regex Figures = new Regex("\"accuracy\":\\s*\\{[^}]*\\}");

        private static readonly string[] Accuracies =
        {
            "{\"level_error_db\": -0.42, \"gfc_recording\": 0.962, \"lsd_db\": 3.18}",
            "{\"level_error_db\": 0.11, \"gfc_recording\": 0.981, \"lsd_db\": 2.27}",
            "{\"level_error_db\": 0.05, \"gfc_recording\": 0.987, \"lsd_db\": 1.94}",
        };

        public static ModelHeader Header() => ModelFiles.HeaderWith(json =>
        {
            int tier = 0;
            return Figures.Replace(json, _ => "\"accuracy\": " + Accuracies[tier++]);
        });

        public static Dictionary<string, TierTiming> Timings() => new Dictionary<string, TierTiming>
        {
            ["draft"] = TierTiming.Of(new[] { 0.21, 0.22, 0.29 }),
            ["standard"] = TierTiming.Of(new[] { 0.45, 0.47, 0.58 }),
        };
    }
}
