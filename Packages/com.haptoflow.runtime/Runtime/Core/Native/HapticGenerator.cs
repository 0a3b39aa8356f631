#nullable enable
using System;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>Generates segments with one tier of a model outside real time: for rendering, measurements and previews.
    /// Any thread that may block.</summary>
    public sealed unsafe class HapticGenerator : IDisposable
    {
        /// <summary>Samples of a segment and of the previous waveform, at 2000 Hz.</summary>
        public const int SegmentSamples = 200;

        /// <summary>Numbers per motion: vx and vy in m/s along the surface, force in N.</summary>
        public const int MotionSize = 3;

        private readonly NativeHandle handle;

        /// <param name="tier">Name of a tier; null for the model's default.</param>
        /// <param name="cancellation">Cancels the creation; null for none.</param>
        /// <exception cref="HaptoFlowException">There is no such tier, a graph is not usable or too slow, or the
        /// creation was cancelled.</exception>
        public HapticGenerator(
            OnnxRuntime runtime, HapticModel model, string? tier = null, HapticCancellation? cancellation = null)
        {
            IntPtr opened;
            fixed (byte* name = tier != null ? NativeCall.Utf8(tier) : null)
            {
                var options = new GeneratorOptions
                {
                    StructSize = (uint)sizeof(GeneratorOptions),
                    Runtime = runtime.Handle.Value,
                    Model = model.Handle.Value,
                    Tier = (IntPtr)name,
                    Cancellation = cancellation?.Handle.Value ?? IntPtr.Zero,
                };
                NativeCall.Check(NativeMethods.GeneratorCreate(&options, &opened));
            }
            GC.KeepAlive(runtime);
            GC.KeepAlive(model);
            GC.KeepAlive(cancellation);
            handle = new NativeHandle(opened, NativeMethods.GeneratorClose);
        }

        /// <summary>Generates a segment in m/s^2 for each request; requests follow each other in the arrays.</summary>
        /// <param name="embeddings">64 numbers each.</param>
        /// <param name="motions">3 numbers each.</param>
        /// <param name="previousMps2">The previous waveforms, 200 samples each.</param>
        /// <param name="noise">200 standard normal numbers each.</param>
        /// <param name="segmentsMps2">Receives the segments, 200 samples each.</param>
        public void Generate(ReadOnlySpan<float> embeddings, ReadOnlySpan<float> motions,
            ReadOnlySpan<float> previousMps2, ReadOnlySpan<float> noise, Span<float> segmentsMps2)
        {
            int count = CountOf(embeddings, motions);
            RequireLength(previousMps2.Length, count * SegmentSamples, nameof(previousMps2));
            RequireLength(noise.Length, count * SegmentSamples, nameof(noise));
            RequireLength(segmentsMps2.Length, count * SegmentSamples, nameof(segmentsMps2));
            fixed (float* embedding = embeddings, motion = motions, previous = previousMps2)
            fixed (float* normal = noise, segment = segmentsMps2)
            {
                var batch = new Batch
                {
                    StructSize = (uint)sizeof(Batch),
                    Count = (uint)count,
                    Embeddings = embedding,
                    Motions = motion,
                    PreviousMps2 = previous,
                    Noise = normal,
                };
                handle.Check(NativeMethods.GeneratorGenerate(handle.Value, &batch, segment));
            }
        }

        /// <summary>Frees the handle after calls under way have finished.</summary>
        public void Dispose() => handle.Dispose();

        private static int CountOf(ReadOnlySpan<float> embeddings, ReadOnlySpan<float> motions)
        {
            int count = motions.Length / MotionSize;
            RequireLength(motions.Length, Math.Max(1, count) * MotionSize, nameof(motions));
            RequireLength(embeddings.Length, count * HapticModel.EmbeddingSize, nameof(embeddings));
            return count;
        }

        private static void RequireLength(int actual, int expected, string name)
        {
            if (actual != expected)
            {
                throw new ArgumentException($"{name} has {actual} numbers; expected {expected}", name);
            }
        }
    }
}
