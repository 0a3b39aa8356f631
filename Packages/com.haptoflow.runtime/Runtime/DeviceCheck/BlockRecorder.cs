#nullable enable
using System;
using System.Threading;

namespace HaptoFlow.DeviceCheck
{
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
