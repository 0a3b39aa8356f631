using HaptoFlow.Outputs;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests.Outputs
{
    public sealed class RetryDelayTests
    {
        [Test]
        public void EachFailureDoublesTheDelayUpToTheLimit()
        {
            var retry = new RetryDelay(0.1, 0.5);
            double now = 10.0;
            foreach (double delay in new[] { 0.1, 0.2, 0.4, 0.5, 0.5 })
            {
                Assert.That(retry.IsDue(now));
                retry.Fail(now);
                Assert.That(retry.IsDue(now + delay - 1e-6), Is.False);
                now += delay + 1e-6;
            }
        }

        [Test]
        public void ASuccessStartsOver()
        {
            var retry = new RetryDelay(0.1, 10.0);
            retry.Fail(1.0);
            retry.Fail(2.0);
            retry.Forget();
            Assert.That(retry.IsDue(2.0));
            retry.Fail(2.0);
            Assert.That(retry.IsDue(2.1001));
        }
    }
}
