using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using HaptoFlow.Native;
using HaptoFlow.Preview;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    /// <summary>The height of a map under the tip of a previewed stroke.</summary>
    public sealed class HeightCurveTests
    {
        private const double Speed = 0.1;

        [TestCase(true)]
        [TestCase(false)]
        public void TheHeightIsThatOfTheMapAtTheTip(bool isTiled)
        {
            // 0 to 2 mm along 40 mm; the stroke begins 8.4 mm from the patch's left edge and goes on for 80 mm.
            PreviewRelief relief = ReliefPreviews.Of(40, 1, (0.04f, 0.1f), 2f, isTiled, (column, _) => column / 39.0);
            var curve = new HeightCurve(Slide(), relief);
            foreach (double metres in new[] { 0.005, 0.02, 0.05, 0.07 })
            {
                double place = (0.0084 + metres) / 0.04;
                double inMap = isTiled ? place - Math.Floor(place) : Math.Min(1.0, place);
                double expected = 2.0 * Math.Max(0.0, Math.Min(1.0, (40.0 * inMap - 0.5) / 39.0));
                (double low, double high) = At(curve, PresetStrokes.LeadSeconds + metres / Speed);
                Assert.That(new[] { low, high }, Is.All.EqualTo(expected).Within(0.05), $"{metres} m");
            }
        }

        [Test]
        public void OnlyATipThatTouchesHasAHeight()
        {
            var curve = new HeightCurve(Slide(), ReliefPreviews.Ribs());
            Assert.That(curve.TryGetExtremes(0.0, 0.08, out _, out _), Is.False, "it is in the air");
            Assert.That(curve.TryGetExtremes(0.0, 1.0, out CurvePoint low, out CurvePoint high), Is.True);
            Assert.That((low.Millimetres, high.Millimetres), Is.EqualTo((0.0, 1.0)));
        }

        [Test]
        public void WhatLiesBetweenTwoStatesIsThere()
        {
            // At 0.1 m/s a state is 1.4 mm from the next: a ridge of half a millimetre lies between most of them.
            PreviewRelief ridge = ReliefPreviews.Of(
                240, 1, (0.12f, 0.1f), 1f, false, (column, _) => column == 100 ? 1.0 : 0.0);
            Assert.That(new HeightCurve(Slide(), ridge).TryGetExtremes(0.0, 1.0, out _, out CurvePoint high), Is.True);
            Assert.That(high.Millimetres, Is.GreaterThan(0.9));
        }

        [Test]
        public void AStrokeThatWrapsInThePictureGoesOnInTheMap()
        {
            // The patch is 120 mm wide, the map 240: its right half is reached by the second round only.
            PreviewRelief step = ReliefPreviews.Of(
                240, 1, (0.24f, 0.1f), 1f, false, (column, _) => column < 120 ? 0.0 : 1.0);
            Stroke stroke = PresetStrokes.Make(StrokePreset.Slide, new StrokeSettings(Speed, 1.0, 0.0, 2.0));
            var curve = new HeightCurve(stroke, step);
            Assert.That(At(curve, PresetStrokes.LeadSeconds + 0.5).High, Is.Zero);
            Assert.That(At(curve, PresetStrokes.LeadSeconds + 1.9).Low, Is.EqualTo(1.0));
        }

        [Test]
        public void AMapOfOneTexelIsEven()
        {
            var curve = new HeightCurve(Slide(), ReliefPreviews.Of(1, 1, (0.001f, 0.001f), 5f, true, (_, __) => 0.5));
            Assert.That(curve.TryGetExtremes(0.0, 1.0, out CurvePoint low, out CurvePoint high), Is.True);
            Assert.That((low.Millimetres, high.Millimetres), Is.EqualTo((2.5, 2.5)).Within(1e-4));
        }

        [Test]
        public void AStrokeOfOnePointHasNoHeightOrOne()
        {
            Stroke point = DrawnStroke.Of(new[] { new DrawnPoint { XMetres = 0.01f, Lands = true } });
            Assert.That(new HeightCurve(point, ReliefPreviews.Ribs()).TryGetExtremes(0.0, 1.0, out _, out _), Is.False);
            var state = new Stroke(_ => new StrokeState { Touching = true, XMetres = 0.0025 }, 0.001, false);
            Assert.That(new HeightCurve(state, ReliefPreviews.Ribs()).TryGetExtremes(0.0, 1.0, out _, out _), Is.True);
        }

        [Test]
        public void APlaceThatIsNoNumberHasNoHeight()
        {
            var lost = new Stroke(_ => new StrokeState { Touching = true, XMetres = double.NaN }, 0.1, false);
            Assert.That(new HeightCurve(lost, ReliefPreviews.Ribs()).TryGetExtremes(0.0, 1.0, out _, out _), Is.False);
            Assert.That(ReliefPreviews.Ribs().Heights.MetresAt(new MapPlace(double.PositiveInfinity, 0.0)), Is.NaN);
            Assert.That(ReliefPreviews.Ribs().Heights.MetresAt(new MapPlace(-1e9, 1e9)), Is.InRange(0.0, 0.001));
        }

        private static Stroke Slide() =>
            PresetStrokes.Make(StrokePreset.Slide, new StrokeSettings(Speed, 1.0, 0.0, 0.8));

        private static (double Low, double High) At(HeightCurve curve, double seconds)
        {
            double share = seconds / curve.DurationSeconds;
            Assert.That(curve.TryGetExtremes(share, share, out CurvePoint low, out CurvePoint high), Is.True);
            Assert.That(low.Seconds, Is.EqualTo(seconds).Within(1e-3));
            return (low.Millimetres, high.Millimetres);
        }
    }

    /// <summary>Strokes over a relief, with the real native library and the default model.</summary>
    public sealed class ReliefRenderingTests
    {
        private static readonly Stroke Slide =
            PresetStrokes.Make(StrokePreset.Slide, new StrokeSettings(0.1, 1.0, 0.0, 0.6));

        private PreviewWorker worker = null!;

        [SetUp]
        public void Begin() => worker = new PreviewWorker();

        [TearDown]
        public void End() => worker.Dispose();

        [Test]
        public void TheReliefIsFeltAtTheRhythmOfItsRibs()
        {
            Assert.That(Of(null, HapticEffects.Nothing).Samples, Is.All.Zero);
            float[] ribs = Of(ReliefPreviews.Ribs(), HapticEffects.Nothing).Samples;
            Assert.That(Of(ReliefPreviews.Bricks(), HapticEffects.Nothing).Samples.SequenceEqual(ribs), Is.False);
            Assert.That(Of(null, HapticEffects.Nothing).Samples, Is.All.Zero, "the map was removed");
            // Ribs of 5 mm at 0.1 m/s: 20 Hz and its harmonics.
            float[] middle = ribs.Skip(12000).Take(19200).ToArray();
            Assert.That(middle.Max(Math.Abs), Is.GreaterThan(0.01f));
            double same = Correlation(middle, 2400);
            Assert.That(same, Is.GreaterThan(0.8).And.GreaterThan(Correlation(middle, 1200) + 0.3), "period 50 ms");
        }

        [Test]
        public void TheShareOfTheRangeIsTheReliefs()
        {
            PreviewRelief ribs = ReliefPreviews.Ribs();
            double loud = Of(ribs, HapticEffects.Nothing).RmsMps2;
            Assert.That(Of(ribs with { Share = 0.01f }, HapticEffects.Nothing).RmsMps2, Is.LessThan(0.5 * loud));
        }

        [Test]
        public void TheLibraryHoldsOneMapAtATimeAndNoneAfterwards()
        {
            using var engines = new PreviewEngines();
            PreviewRelief ribs = ReliefPreviews.Ribs();
            uint first = engines.Relief(ribs);
            Assert.That(engines.Relief(ribs with { Share = 0.1f }), Is.EqualTo(first).And.Not.Zero);
            uint second = engines.Relief(ReliefPreviews.Ribs());
            Assert.That(IsGone(first), Is.True);
            Assert.That(engines.Relief(null), Is.Zero);
            Assert.That(IsGone(second), Is.True);
            uint third = engines.Relief(ribs);
            engines.Dispose();
            Assert.That(IsGone(third), Is.True);
        }

        [Test]
        public void AMapThatTheLibraryRefusesIsNamed()
        {
            var endless = new PreviewRelief("Waves", new ReliefHeights(new ushort[4], 2)
            {
                SizeMetres = (float.PositiveInfinity, 1f),
                DepthMetres = 0.001f,
            }, 0.5f);
            PreviewResult result = Do(Request(endless, HapticEffects.Texture));
            Assert.That(result.Problem, Does.StartWith("the relief Waves cannot be felt: ").And.Contain("size"));
            Assert.That(result.Sounds, Is.Empty);
            Assert.That(Do(Request(null, HapticEffects.Texture)).Problem, Is.Null);
        }

        [Test]
        public void AStrokeThatWrapsInThePictureIsFeltWhereItGoesOnInTheMap()
        {
            // Ribs begin where the stroke enters the patch again, after 1.1 s.
            PreviewRelief far = ReliefPreviews.Of(
                240, 1, (0.24f, 0.1f), 1f, false, (column, _) => column < 120 || column % 6 < 3 ? 0.0 : 1.0);
            Stroke stroke = PresetStrokes.Make(StrokePreset.Slide, new StrokeSettings(0.1, 1.0, 0.0, 2.0));
            PreviewRequest request = Request(far, HapticEffects.Nothing) with { Stroke = stroke };
            float[] samples = Do(request).Sounds[0].Sound.Samples;
            Assert.That(samples.Skip(48000 * 4 / 10).Take(38000).Max(Math.Abs), Is.LessThan(1e-3f));
            Assert.That(samples.Skip(48000 * 14 / 10).Take(24000).Max(Math.Abs), Is.GreaterThan(0.02f));
        }

        [Test]
        public void BothMaterialsGoOverTheSameRelief()
        {
            var both = new PreviewRequest(
                ModelFiles.Default, Slide, new[] { new LabelMix("wood"), new LabelMix("cotton") })
            {
                Tier = "sketch", Relief = ReliefPreviews.Ribs(), Effects = HapticEffects.Nothing,
            };
            PreviewResult result = Do(both);
            Assert.That(result.Problem, Is.Null);
            Assert.That(result.Sounds.Select(each => each.Sound.PeakMps2), Is.All.GreaterThan(1.0));
            Assert.That(result.Heights!.DepthMillimetres, Is.EqualTo(1.0).Within(1e-6));
        }

        private PreviewSound Of(PreviewRelief? relief, HapticEffects effects)
        {
            PreviewResult result = Do(Request(relief, effects));
            Assert.That(result.Problem, Is.Null);
            return result.Sounds[0].Sound;
        }

        private static PreviewRequest Request(PreviewRelief? relief, HapticEffects effects) =>
            new PreviewRequest(ModelFiles.Default, Slide, new[] { new LabelMix("wood") })
            {
                Tier = "sketch", Relief = relief, Effects = effects,
            };

        private PreviewResult Do(PreviewRequest request) => worker.Do(request, CancellationToken.None);

        /// <summary>Correlation of a wave with itself after a delay.</summary>
        private static double Correlation(float[] wave, int delay)
        {
            double product = 0.0;
            double power = 0.0;
            for (int index = delay; index < wave.Length; ++index)
            {
                product += wave[index] * (double)wave[index - delay];
                power += wave[index] * (double)wave[index];
            }
            return product / power;
        }

        private static unsafe bool IsGone(uint number) => NativeMethods.ReliefDestroy(&number) != 0;
    }

    /// <summary>Reliefs for previews.</summary>
    internal static class ReliefPreviews
    {
        /// <summary>Ribs of 5 mm, a millimetre high.</summary>
        public static PreviewRelief Ribs() => Of(
            100, 2, (0.02f, 0.01f), 1f, true, (column, _) => column % 25 < 12 ? 0.0 : 1.0);

        /// <summary>Bricks of 60 x 25 mm with joints of 6 mm, 1.5 mm deep.</summary>
        public static PreviewRelief Bricks() => Of(264, 124, (0.132f, 0.062f), 1.5f, true, (column, row) =>
        {
            int across = (column + (row < 62 ? 0 : 66)) % 132;
            return across < 12 || row % 62 < 12 ? 0.0 : 1.0;
        });

        public static PreviewRelief Of(int columns, int rows, (float, float) sizeMetres, float depthMillimetres,
            bool isTiled, Func<int, int, double> share)
        {
            ushort[] shares = Enumerable.Range(0, columns * rows)
                .Select(texel => (ushort)(ushort.MaxValue * share(texel % columns, texel / columns) + 0.5)).ToArray();
            return new PreviewRelief("Waves", new ReliefHeights(shares, columns)
            {
                SizeMetres = sizeMetres,
                DepthMetres = 0.001f * depthMillimetres,
                TipRadiusMetres = 0.0005f,
                IsTiled = isTiled,
            }, 0.5f);
        }
    }
}
