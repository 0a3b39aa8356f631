#nullable enable
using System;
using System.Threading;
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

        /// <summary>Statistics of the voice.</summary>
        public VoiceStatistics Statistics => voice.Statistics();

        /// <summary>Begins to record blocks anew.</summary>
        public void Record()
        {
            Blocks = new BlockRecorder();
            output.Recorder = Blocks;
        }

        /// <summary>Publishes the state of this frame.</summary>
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

        /// <summary>Ends the stroke and removes the output.</summary>
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

        /// <summary>Number of blocks so far.</summary>
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

        /// <summary>Audio thread, before a block.</summary>
        public void Begin() => bytesBefore = countsBytes ? GC.GetAllocatedBytesForCurrentThread() : 0;

        /// <summary>Audio thread, after a block.</summary>
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
}
