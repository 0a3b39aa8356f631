#nullable enable
using System;
using System.Threading;
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow.DeviceCheck
{
    /// <summary>A voice that plays a simulated stroke on an audio output of its own, so that audio thread and engine
    /// are measured alike on every device. Main thread.</summary>
    internal sealed class SimulatedStroke : IDisposable
    {
        private const double StrokesPerSecond = 1.5;
        private const float FastestMps = 0.15f;
        private const float ForceNewtons = 0.5f;
        private readonly HapticOutput output = HapticOutput.Make();
        private readonly HapticVoice voice;
        private readonly double beganSeconds = Time.realtimeSinceStartupAsDouble;

        public SimulatedStroke(HapticEngine engine)
        {
            voice = engine.OpenVoice(output.SampleRateHz);
            ((IVoiceTarget)output).Add(voice);
            Record();
        }

        /// <summary>Blocks since the last call of <see cref="Record"/>.</summary>
        public BlockRecorder Blocks { get; private set; } = null!;

        public VoiceStatistics Statistics => voice.Statistics();

        public void Record()
        {
            Blocks = new BlockRecorder();
            output.Recorder = Blocks;
        }

        public void Publish()
        {
            double phase = 2.0 * Math.PI * StrokesPerSecond * (Time.realtimeSinceStartupAsDouble - beganSeconds);
            voice.Publish(new ContactState
            {
                Touching = true,
                TouchCounter = 1,
                FirstVelocityMps = FastestMps * (float)Math.Cos(phase),
                ForceNewtons = ForceNewtons,
                Material = LabelBlend.Of(0),
                Effects = HapticEffects.Texture,
            });
        }

        public void Dispose()
        {
            output.Recorder = null;
            voice.Dispose();
            if (output != null)
            {
                UnityEngine.Object.Destroy(output.gameObject);
            }
        }
    }

    /// <summary>Times and allocations of an output's blocks. The audio thread writes, without garbage or locks; another
    /// thread reads.</summary>
    internal sealed class BlockRecorder
    {
        private const int Capacity = 16384;
        private readonly float[] milliseconds = new float[Capacity];
        private readonly bool countsBytes;
        private int blocks;
        private long bytes;
        private long bytesBefore = -1;

        public BlockRecorder() => countsBytes = CountsAllocations();

        public int Blocks => Volatile.Read(ref blocks);

        /// <summary>Bytes that rendering allocated; null where this runtime does not count them per thread.</summary>
        public long? AllocatedBytes => countsBytes ? Interlocked.Read(ref bytes) : (long?)null;

        /// <summary>Render times so far, ascending, in ms.</summary>
        public float[] SortedMilliseconds()
        {
            var copy = new float[Math.Min(Blocks, Capacity)];
            Array.Copy(milliseconds, copy, copy.Length);
            Array.Sort(copy);
            return copy;
        }

        public void Begin() => bytesBefore = countsBytes ? GC.GetAllocatedBytesForCurrentThread() : 0;

        public void End(float elapsedMilliseconds)
        {
            if (bytesBefore < 0)
            {
                // The recorder was attached within this block.
                return;
            }
            if (countsBytes)
            {
                Interlocked.Add(ref bytes, GC.GetAllocatedBytesForCurrentThread() - bytesBefore);
            }
            if (blocks < Capacity)
            {
                milliseconds[blocks] = elapsedMilliseconds;
            }
            Volatile.Write(ref blocks, blocks + 1);
        }

        /// <summary>True where this runtime counts the bytes that a thread allocates. Some always answer 0, and some lack
        /// the call, so it is tried.</summary>
        private static bool CountsAllocations()
        {
            const int Probe = 1 << 17;
            try
            {
                long before = GC.GetAllocatedBytesForCurrentThread();
                GC.KeepAlive(new byte[Probe]);
                return GC.GetAllocatedBytesForCurrentThread() - before >= Probe;
            }
            catch (Exception)
            {
                return false;
            }
        }
    }

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

        public bool HasDevice => sink.TryGetCapabilities(out _);

        public void Update(double nowSeconds)
        {
            queue ??= HapticQueue.For(form, sink, new TestWave());
            queue.Update(nowSeconds);
        }

        public RouteFacts Facts()
        {
            sink.TryGetCapabilities(out HapticSinkCapabilities capabilities);
            return new RouteFacts(hand, route, form, sink.Name, capabilities.RateHz, capabilities.MaximumSamples,
                sink.Submissions, sink.Refused, queue?.Statistics.Gaps ?? 0);
        }

        public void Stop(double nowSeconds) => queue?.Flush(nowSeconds);

        public void Dispose()
        {
            if (queue != null)
            {
                sink.Stop();
                queue.Dispose();
            }
            sink.Dispose();
        }

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
