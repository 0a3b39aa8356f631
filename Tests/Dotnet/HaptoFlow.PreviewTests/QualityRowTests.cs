using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    public sealed class QualityRowTests
    {
        private static readonly Dictionary<string, TierTiming> Untimed = new Dictionary<string, TierTiming>();

        [Test]
        public void ARowHasTheAccuracyOfTheHeaderAndTheTimeOfThisMachine()
        {
            ModelHeader header = MeasuredModel.Header();
            IReadOnlyList<QualityRow> rows = QualityRow.Of(header, MeasuredModel.Timings());
            Assert.That(rows.Select(row => row.Name), Is.EqualTo(header.Tiers.Select(tier => tier.Name)));
            Assert.That(rows[0].LevelErrorDecibels, Is.EqualTo(-0.42));
            Assert.That(rows[0].GoodnessOfFit, Is.EqualTo(0.962));
            Assert.That(rows[0].SpectralDistanceDecibels, Is.EqualTo(3.18));
            QualityRow standard = rows.Single(row => row.Name == "standard");
            Assert.That(standard.IsDefault, Is.True);
            Assert.That(standard.Timing!.MedianMs, Is.EqualTo(0.47));
        }

        [Test]
        public void ValuesMissingInTheHeaderAreNull()
        {
            ModelHeader header = ModelFiles.HeaderWith(json => MeasuredModel.Figures.Replace(json, "\"accuracy\": {}"));
            QualityRow row = QualityRow.Of(header, Untimed)[0];
            Assert.That(row.HasAccuracy, Is.False);
            Assert.That((row.LevelErrorDecibels, row.GoodnessOfFit, row.Timing),
                Is.EqualTo(((double?)null, (double?)null, (TierTiming?)null)));
        }

        [Test]
        public void PercentilesAreByNearestRank()
        {
            TierTiming timing = TierTiming.Of(Enumerable.Range(1, 10).Select(value => 11.0 - value).ToArray());
            Assert.That((timing.Count, timing.MedianMs, timing.Percentile90Ms), Is.EqualTo((10, 5.0, 9.0)));
        }
    }
}
