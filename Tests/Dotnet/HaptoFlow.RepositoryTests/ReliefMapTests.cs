using System;
using System.Linq;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>Reliefs of the native library, as C# makes them and names them in contact states.</summary>
    public sealed class ReliefMapTests : OpenModelTest
    {
        private static readonly (float, float) Size = (0.1f, 0.1f);

        [Test]
        public void ATipFollowsTheHeightsAlongItsWayInTheMap()
        {
            using HapticReliefMap ribs = Ribs();
            double without = Level(0, (10.0, 0.0), 0.5f);
            double across = Level(ribs.Number, (10.0, 0.0), 0.5f);
            double along = Level(ribs.Number, (0.0, 10.0), 0.5f);
            Assert.That(without, Is.Zero, "the relief is the only effect");
            Assert.That(across, Is.GreaterThan(0.01));
            Assert.That(along, Is.LessThan(0.1 * across));
        }

        [Test]
        public void ASmallerShareOfTheRangeIsQuieter()
        {
            using HapticReliefMap ribs = Ribs();
            Assert.That(Level(ribs.Number, (10.0, 0.0), 0.01f),
                Is.LessThan(0.5 * Level(ribs.Number, (10.0, 0.0), 0.5f)));
        }

        [Test]
        public void ADisposedReliefIsSilent()
        {
            HapticReliefMap ribs = Ribs();
            uint number = ribs.Number;
            ribs.Dispose();
            ribs.Dispose();
            Assert.That(number, Is.Not.Zero);
            Assert.That(ribs.Number, Is.Zero);
            Assert.That(Level(number, (10.0, 0.0), 0.5f), Is.Zero);
        }

        [Test]
        public void ARefusalNamesTheNumber()
        {
            var refusal = Assert.Throws<HaptoFlowException>(
                () => new HapticReliefMap(new float[4], 2, (0f, 1f), 0.001f, 0f, true));
            Assert.That(refusal!.Message, Does.Contain("size"));
            Assert.Throws<HaptoFlowException>(() => new HapticReliefMap(new float[4], 0, Size, 0.001f, 0f, true));
            Assert.Throws<HaptoFlowException>(
                () => new HapticReliefMap(Array.Empty<float>(), 2, Size, 0.001f, 0f, true));
        }

        [Test]
        public void HeightsHaveTheSlopesOfTheirNormals()
        {
            const int Columns = 64;
            const int Rows = 32;
            const double Amplitude = 0.001;
            var normals = new float[3 * Columns * Rows];
            double Phase(int texel) => 2.0 * Math.PI * (texel % Columns) / Columns;
            for (int texel = 0; texel < Columns * Rows; ++texel)
            {
                normals[3 * texel] = (float)(-Amplitude * 2.0 * Math.PI / 0.2 * Math.Cos(Phase(texel)));
                normals[3 * texel + 2] = 1f;
            }
            float[] heights = HapticReliefMap.HeightsOfNormals(normals, Columns, (0.2f, 0.1f), true);
            Assert.That(heights, Has.Length.EqualTo(Columns * Rows));
            for (int texel = 0; texel < heights.Length; ++texel)
            {
                Assert.That(heights[texel], Is.EqualTo(Amplitude * (1.0 + Math.Sin(Phase(texel)))).Within(2e-5));
            }
        }

        /// <summary>A sine of 2 mm along the columns.</summary>
        private static HapticReliefMap Ribs() => new HapticReliefMap(
            Enumerable.Range(0, 800 * 2)
                .Select(texel => 1e-4f * (1f + (float)Math.Sin(2.0 * Math.PI * texel / 16.0))).ToArray(),
            800, Size, 0.0002f, 0.0005f, true);

        /// <summary>The RMS level of a tip that slides at 0.1 m/s, of full scale.</summary>
        private double Level(uint relief, (double Columns, double Rows) perMetre, float share)
        {
            using HapticEngine engine = EngineWithoutWorker();
            using HapticVoice voice = engine.OpenVoice(48000.0);
            ContactState state = Sliding(1);
            (state.FirstVelocityMps, state.SecondVelocityMps) = (0.1f, 0f);
            (state.Effects, state.Relief, state.ReliefShare) = (HapticEffects.Relief, relief, share);
            var block = new float[512];
            double squares = 0.0;
            for (int count = 0; count < 60; ++count)
            {
                double metres = 0.1 * 512.0 / 48000.0 * count;
                state.ReliefPlace = new MapPlace(perMetre.Columns * metres, perMetre.Rows * metres);
                Assert.That(voice.Publish(state), Is.True);
                engine.Step();
                voice.Render(block, 1, 0, 48000.0);
                squares += count < 20 ? 0.0 : block.Sum(sample => sample * sample);
            }
            return Math.Sqrt(squares / (40.0 * block.Length));
        }
    }
}
