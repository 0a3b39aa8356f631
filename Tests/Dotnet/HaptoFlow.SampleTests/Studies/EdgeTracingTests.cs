using HaptoFlow.Samples.SimilarityStudy;
using NUnit.Framework;

namespace HaptoFlow.SampleTests
{
    /// <summary>Tracing of a rectangle of 20 x 15 cm with a tolerance of 1 cm.</summary>
    public sealed class EdgeTracingTests
    {
        private EdgeTracing tracing = null!;

        [SetUp]
        public void Begin() => tracing = new EdgeTracing(0.2, 0.15, 0.01, 0.9);

        [Test]
        public void TracingAllEdgesInAnyOrderCompletesTheRectangle()
        {
            Line(0.1, 0.075, 0.1, -0.075);
            Line(-0.1, 0.075, 0.1, 0.075);
            Line(0.1, -0.075, -0.1, -0.075);
            Assert.That((tracing.TracedEdges, tracing.IsComplete), Is.EqualTo((3, false)));
            Line(-0.1, -0.075, -0.1, 0.075);
            Assert.That(tracing.IsComplete, Is.True);
        }

        [TestCase(0.85, false)]
        [TestCase(0.95, true)]
        public void AnEdgeIsTracedWhenItsRequiredShareIsCovered(double share, bool isTraced)
        {
            Line(-0.1, -0.075, -0.1 + 0.2 * share, -0.075);
            Assert.That(tracing.IsTraced(0), Is.EqualTo(isTraced));
        }

        [Test]
        public void ALineBesideAnEdgeAndPositionsThatAreNoNumbersTraceNothing()
        {
            Line(-0.09, -0.06, 0.09, -0.06);
            Line(-0.09, 0.0, 0.09, 0.0);
            tracing.Add(double.NaN, double.NaN);
            tracing.Add(double.PositiveInfinity, 0.0);
            Assert.That(tracing.TracedEdges, Is.Zero);
        }

        [TestCase(0.04, false, true, Description = "positions of a fast hand are connected")]
        [TestCase(0.04, true, false, Description = "parts passed while lifted are not traced")]
        [TestCase(0.2, false, false, Description = "a jump along an edge traces nothing between")]
        public void TouchingPositionsAreConnectedUpToTheStepOfAFastHand(double step, bool lifts, bool isTraced)
        {
            for (double x = -0.1; x <= 0.1001; x += step)
            {
                tracing.Add(x, -0.075);
                if (lifts)
                {
                    tracing.Lift();
                }
            }
            Assert.That(tracing.IsTraced(0), Is.EqualTo(isTraced));
        }

        [Test]
        public void StartingAnewClearsTheTracedEdges()
        {
            Line(-0.1, -0.075, 0.1, -0.075);
            tracing.Begin();
            Assert.That(tracing.TracedEdges, Is.Zero);
        }

        private void Line(double fromX, double fromZ, double toX, double toZ)
        {
            tracing.Lift();
            for (int step = 0; step <= 50; ++step)
            {
                double share = step / 50.0;
                tracing.Add(fromX + share * (toX - fromX), fromZ + share * (toZ - fromZ));
            }
        }
    }
}
