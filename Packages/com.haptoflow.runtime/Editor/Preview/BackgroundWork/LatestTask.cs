#nullable enable
using System;
using System.Threading;
using System.Threading.Tasks;

namespace HaptoFlow.Preview
{
    /// <summary>Does work in the background, one request at a time; of those that come in meanwhile the newest is next,
    /// the others are never begun. All methods from one thread.</summary>
    internal sealed class LatestTask<TRequest, TResult> : IDisposable
        where TRequest : class
        where TResult : class
    {
        private readonly Func<TRequest, CancellationToken, TResult> work;
        private readonly CancellationTokenSource ending = new CancellationTokenSource();
        private TRequest? waiting;
        private Task<TResult>? running;

        /// <param name="work">Called in the background, never twice at the same time.</param>
        public LatestTask(Func<TRequest, CancellationToken, TResult> work) => this.work = work;

        /// <summary>Something is under way or waiting.</summary>
        public bool IsBusy => running != null || waiting != null;

        public void Ask(TRequest request)
        {
            waiting = request;
            StartNext();
        }

        /// <summary>Takes what was finished, and begins what waits.</summary>
        /// <returns>Null where nothing was finished since the last call.</returns>
        /// <exception cref="Exception">What the work threw.</exception>
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

        /// <summary>Waits until the present request is done; what waits begins. For tests and for the end.</summary>
        public void Wait()
        {
            if (running != null)
            {
                ((IAsyncResult)running).AsyncWaitHandle.WaitOne();
            }
        }

        /// <summary>Cancels what is under way and waits for its end: native calls must not outlive the domain.
        /// </summary>
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
