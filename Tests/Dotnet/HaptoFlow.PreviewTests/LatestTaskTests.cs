using System;
using System.Collections.Concurrent;
using System.Linq;
using System.Threading;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    public sealed class LatestTaskTests
    {
        [Test]
        public void OnlyTheNewestWaitingRequestIsRun()
        {
            using var gate = new SemaphoreSlim(0);
            var begun = new ConcurrentQueue<string>();
            using var task = new LatestTask<string, string>((request, _) =>
            {
                begun.Enqueue(request);
                gate.Wait(CancellationToken.None);
                return request + "!";
            });
            task.Submit("first");
            task.Submit("second");
            task.Submit("third");
            gate.Release(2);
            task.Wait();
            Assert.That(task.Poll(), Is.EqualTo("first!"));
            Assert.That(task.IsBusy, Is.True);
            task.Wait();
            Assert.That(task.Poll(), Is.EqualTo("third!"));
            Assert.That(task.IsBusy, Is.False);
            Assert.That(task.Poll(), Is.Null);
            Assert.That(begun, Is.EqualTo(new[] { "first", "third" }));
        }

        [Test]
        public void PollThrowsTheExceptionOfTheWorkAndTheNextRequestRuns()
        {
            using var task = new LatestTask<string, string>((request, _) =>
                request == "bad" ? throw new FormatException("bad request") : request);
            task.Submit("bad");
            task.Submit("good");
            task.Wait();
            Assert.That(() => task.Poll(), Throws.TypeOf<FormatException>());
            task.Wait();
            Assert.That(task.Poll(), Is.EqualTo("good"));
        }

        [Test]
        public void DisposeCancelsTheRunningRequestAndWaitsForIt()
        {
            using var begun = new ManualResetEventSlim();
            bool ended = false;
            var task = new LatestTask<string, string>((request, token) =>
            {
                begun.Set();
                token.WaitHandle.WaitOne();
                Volatile.Write(ref ended, true);
                token.ThrowIfCancellationRequested();
                return request;
            });
            task.Submit("endless");
            task.Submit("never run");
            begun.Wait();
            task.Dispose();
            Assert.That(Volatile.Read(ref ended), Is.True);
            Assert.That(task.IsBusy, Is.False);
        }

        [Test]
        public void WorkNeverRunsTwiceAtTheSameTime()
        {
            int inside = 0;
            int most = 0;
            using var task = new LatestTask<string, string>((request, _) =>
            {
                most = Math.Max(most, Interlocked.Increment(ref inside));
                Interlocked.Decrement(ref inside);
                return request;
            });
            foreach (int number in Enumerable.Range(0, 200))
            {
                task.Submit(number.ToString());
                task.Poll();
            }
            while (task.IsBusy)
            {
                task.Wait();
                task.Poll();
            }
            Assert.That(most, Is.EqualTo(1));
        }
    }
}
