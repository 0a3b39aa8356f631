#nullable enable
using System;
using System.Threading;
using System.Threading.Tasks;

namespace HaptoFlow.Preview
{
    /// <summary>Works on one request at a time in the background. Of the requests submitted meanwhile only the newest
    /// is kept. Call all methods from one thread.</summary>
    internal sealed class LatestTask<TRequest, TResult> : IDisposable
        where TRequest : class
        where TResult : class
    {
        private readonly Func<TRequest, CancellationToken, TResult> work;
        private readonly CancellationTokenSource ending = new CancellationTokenSource();
        private TRequest? waiting;
        private Task<TResult>? running;

        /// <param name="work">Runs in the background, never twice at the same time.</param>
        public LatestTask(Func<TRequest, CancellationToken, TResult> work) => this.work = work;

        public bool IsBusy => running != null || waiting != null;

        /// <summary>Starts a request, or keeps it until the running one is finished.</summary>
        public void Submit(TRequest request)
        {
            waiting = request;
            StartNext();
        }

        /// <summary>Takes the finished result, and starts the waiting request.</summary>
        /// <returns>Null if nothing was finished since the last call.</returns>
        /// <exception cref="Exception">The exception that the work threw.</exception>
        public TResult? Poll()
        {
            if (running == null || !running.IsCompleted)
            {
                return null;
            }
            Task<TResult> finished = running;
            running = null;
            StartNext();
            return finished.GetAwaiter().GetResult();
        }

        /// <summary>Blocks until the running request ends. <see cref="Poll"/> then starts the waiting one.</summary>
        public void Wait()
        {
            if (running != null)
            {
                ((IAsyncResult)running).AsyncWaitHandle.WaitOne();
            }
        }

        /// <summary>Cancels the running request and waits until it ends, because native calls must not outlive a domain
        /// reload.</summary>
        public void Dispose()
        {
            waiting = null;
            ending.Cancel();
            Wait();
            running = null;
            ending.Dispose();
        }

        private void StartNext()
        {
            if (running != null || waiting == null)
            {
                return;
            }
            TRequest request = waiting;
            waiting = null;
            CancellationToken token = ending.Token;
            running = Task.Run(() => work(request, token));
        }
    }
}
