#nullable enable
using System;
using HaptoFlow.Outputs;

namespace HaptoFlow.DeviceCheck
{
    /// <summary>Plays a test wave through one route to a device, with the queue that outputs use, and counts what the
    /// device accepts. Main thread.</summary>
    internal sealed class RouteTrial : IDisposable
    {
        private readonly string hand;
        private readonly string route;
        private readonly HapticForm form;
        private readonly CountingSink sink;
        private HapticQueue? queue;

        public RouteTrial(string hand, string route, HapticForm form, IHapticSink device)
        {
            this.hand = hand;
            this.route = route;
            this.form = form;
            sink = new CountingSink(device);
        }

        /// <summary>False while the device is absent.</summary>
        public bool HasDevice => sink.TryGetCapabilities(out _);

        /// <summary>Plays on; call it once a frame.</summary>
        public void Update(double nowSeconds)
        {
            queue ??= HapticQueue.For(form, sink, new TestWave());
            queue.Update(nowSeconds);
        }

        public RouteFacts Facts()
        {
            sink.TryGetCapabilities(out HapticSinkCapabilities capabilities);
            return new RouteFacts
            {
                Hand = hand,
                Route = route,
                Form = form,
                Device = sink.Name,
                RateHz = capabilities.RateHz,
                MaximumSamples = capabilities.MaximumSamples,
                Submissions = sink.Submissions,
                Refused = sink.Refused,
                Gaps = queue?.Statistics.Gaps ?? 0,
            };
        }

        public void Stop(double nowSeconds) => queue?.Flush(nowSeconds);

        /// <summary>Stops the device and leaves it.</summary>
        public void Dispose()
        {
            if (queue != null)
            {
                sink.Stop();
                queue.Dispose();
            }
            sink.Dispose();
        }

        /// <summary>A sine of 160 Hz at half of the full amplitude.</summary>
        private sealed class TestWave : IWaveSource
        {
            private const double FrequencyHz = 160.0;
            private long position;

            public bool IsStopped => false;

            public void Render(Span<float> samples)
            {
                for (int index = 0; index < samples.Length; ++index)
                {
                    double seconds = position++ / WaveHistory.RateHz;
                    samples[index] = 0.5f * (float)Math.Sin(2.0 * Math.PI * FrequencyHz * seconds);
                }
            }
        }

        private sealed class CountingSink : IWaveformSink, IParametricSink, IAmplitudeSink, IDisposable
        {
            private readonly IHapticSink device;

            public CountingSink(IHapticSink device) => this.device = device;

            public long Submissions { get; private set; }

            public long Refused { get; private set; }

            public string Name => device.Name;

            public bool ReplacesWithoutGap => ((IWaveformSink)device).ReplacesWithoutGap;

            public bool TryGetCapabilities(out HapticSinkCapabilities capabilities) =>
                device.TryGetCapabilities(out capabilities);

            public int Submit(ReadOnlySpan<float> samples, bool replace)
            {
                int accepted = ((IWaveformSink)device).Submit(samples, replace);
                Count(accepted == samples.Length);
                return accepted;
            }

            public bool Submit(ReadOnlySpan<ParametricPoint> amplitudes, ReadOnlySpan<ParametricPoint> frequencies,
                ReadOnlySpan<ParametricTransient> transients, StreamPart part) =>
                Count(((IParametricSink)device).Submit(amplitudes, frequencies, transients, part));

            public bool Submit(float amplitude, float frequencyHz, float durationSeconds) =>
                Count(((IAmplitudeSink)device).Submit(amplitude, frequencyHz, durationSeconds));

            public void Stop() => device.Stop();

            public void Dispose() => (device as IDisposable)?.Dispose();

            private bool Count(bool accepted)
            {
                ++Submissions;
                Refused += accepted ? 0 : 1;
                return accepted;
            }
        }
    }
}
