#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>Solver of the velocity field's ordinary differential equation.</summary>
    public enum HapticSolver
    {
        /// <summary>The solver and the steps of the tier.</summary>
        OfTier = 0,

        /// <summary>One evaluation per step.</summary>
        Euler = 1,

        /// <summary>Two evaluations per step.</summary>
        Midpoint = 2,

        /// <summary>Two evaluations per step.</summary>
        Heun = 3,
    }

    /// <summary>A label of a model, or a material registered in addition.</summary>
    public sealed class HapticLabel
    {
        internal HapticLabel(in LabelInfo info, int index)
        {
            Index = index;
            Name = NativeCall.Text(info.Name);
            Category = NativeCall.Text(info.Category);
            StiffnessNewtonsPerMetre = info.StiffnessNewtonsPerMetre;
            FrictionCoefficient = info.FrictionCoefficient;
            WavelengthMetres = info.IsPeriodic != 0 ? info.WavelengthMetres : (double?)null;
        }

        /// <summary>Index for a <see cref="LabelBlend"/>; indices of registered materials follow those of the model's
        /// labels.</summary>
        public int Index { get; }

        /// <summary>Name; for a label lower case and unique in the model, for example "metal mesh".</summary>
        public string Name { get; }

        /// <summary>For example "wood" or "cloth".</summary>
        public string Category { get; }

        /// <summary>Default stiffness of the spring model.</summary>
        public double StiffnessNewtonsPerMetre { get; }

        /// <summary>Mean coefficient of kinetic friction.</summary>
        public double FrictionCoefficient { get; }

        /// <summary>Wavelength of a woven or ruled surface; null for others.</summary>
        public double? WavelengthMetres { get; }
    }

    /// <summary>A tier of a model: a network with a measured accuracy and a measured cost.</summary>
    public sealed class HapticTier
    {
        internal HapticTier(in TierInfo info, int index)
        {
            Index = index;
            Name = NativeCall.Text(info.Name);
            Kind = NativeCall.Text(info.Kind);
            AccuracyJson = NativeCall.Text(info.AccuracyJson);
            CostJson = NativeCall.Text(info.CostJson);
            Solver = (HapticSolver)info.Solver;
            Steps = info.Steps;
            IsDefault = info.IsDefault != 0;
            ParameterCount = info.ParameterCount;
        }

        /// <summary>Index among the model's tiers.</summary>
        public int Index { get; }

        /// <summary>Usually "sketch", "draft" or "standard".</summary>
        public string Name { get; }

        /// <summary>"flow", "average-velocity" or "direct".</summary>
        public string Kind { get; }

        /// <summary>Measured figures as a JSON object; "{}" where nothing was measured.</summary>
        public string AccuracyJson { get; }

        /// <summary>Measured figures as a JSON object; "{}" where nothing was measured.</summary>
        public string CostJson { get; }

        /// <summary>The tier's own solver.</summary>
        public HapticSolver Solver { get; }

        /// <summary>Solver steps, 1 to 16.</summary>
        public int Steps { get; }

        /// <summary>True for the tier that is used unless another is selected.</summary>
        public bool IsDefault { get; }

        /// <summary>Number of weights of the network.</summary>
        public long ParameterCount { get; }
    }

    /// <summary>A model opened and verified by the native library. Any thread; opening takes milliseconds per
    /// megabyte.</summary>
    public sealed unsafe class HapticModel : IDisposable
    {
        /// <summary>Length of a material embedding.</summary>
        public const int EmbeddingSize = 64;

        private HapticModel(IntPtr opened)
        {
            Handle = new NativeHandle(opened, NativeMethods.ModelClose);
            var info = new ModelInfo { StructSize = (uint)sizeof(ModelInfo) };
            NativeCall.Check(NativeMethods.ModelDescribe(opened, &info));
            Header = new ModelHeader(info, ReadSpace(opened), ReadLabels(opened), ReadTiers(opened));
        }

        /// <summary>What the model's header says; it stays valid without the model.</summary>
        public ModelHeader Header { get; }

        /// <summary>The labels in the order of their indices.</summary>
        public IReadOnlyList<HapticLabel> Labels => Header.Labels;

        /// <summary>The tiers in order of increasing accuracy.</summary>
        public IReadOnlyList<HapticTier> Tiers => Header.Tiers;

        internal NativeHandle Handle { get; }

        /// <param name="file">The whole .haptoflow file; the array is not kept.</param>
        /// <exception cref="HaptoFlowException">The library is missing, or the bytes are not a usable
        /// model.</exception>
        public static HapticModel Open(byte[] file)
        {
            // An empty array has no address, and the library says of an empty file what is wrong with it.
            fixed (byte* bytes = file.Length > 0 ? file : new byte[1])
            {
                var options = new ModelOptions
                {
                    StructSize = (uint)sizeof(ModelOptions),
                    Bytes = (IntPtr)bytes,
                    ByteCount = (ulong)file.LongLength,
                };
                return Open(&options);
            }
        }

        /// <param name="path">Path of a .haptoflow file.</param>
        /// <exception cref="HaptoFlowException">The library is missing, or the file is not a usable model.</exception>
        public static HapticModel Open(string path)
        {
            fixed (byte* text = NativeCall.Utf8(path))
            {
                var options = new ModelOptions { StructSize = (uint)sizeof(ModelOptions), Path = (IntPtr)text };
                return Open(&options);
            }
        }

        /// <summary>Identifies the space of the model's embeddings, as 8 hexadecimal digits: a material file can be
        /// used with every model of the same space.</summary>
        public string Space => Header.Space;

        /// <summary>The JSON header of the file, unchanged.</summary>
        public string HeaderJson()
        {
            IntPtr text;
            Handle.Check(NativeMethods.ModelHeader(Handle.Value, &text));
            // The text is the model's.
            string json = NativeCall.Text(text);
            GC.KeepAlive(this);
            return json;
        }

        /// <summary>The material embedding of a label, <see cref="EmbeddingSize"/> numbers.</summary>
        public float[] Embedding(int label)
        {
            var embedding = new float[EmbeddingSize];
            fixed (float* numbers = embedding)
            {
                Handle.Check(NativeMethods.ModelEmbedding(Handle.Value, checked((uint)label), numbers));
            }
            return embedding;
        }

        /// <summary>Name of the label whose embedding is nearest, ignoring wave vectors.</summary>
        /// <param name="embedding"><see cref="EmbeddingSize"/> numbers, as of a <see cref="MaterialFile"/>.</param>
        /// <exception cref="ArgumentException">It has another length.</exception>
        public string NearestLabel(IReadOnlyList<double> embedding)
        {
            if (embedding.Count != EmbeddingSize)
            {
                throw new ArgumentException(
                    $"the embedding has {embedding.Count} numbers; expected {EmbeddingSize}", nameof(embedding));
            }
            float[] wanted = embedding.Select(number => (float)number).ToArray();
            uint index;
            fixed (float* numbers = wanted)
            {
                Handle.Check(NativeMethods.ModelNearestLabel(Handle.Value, numbers, &index));
            }
            return Labels[(int)index].Name;
        }

        /// <summary>Frees the handle; engines and generators created from the model stay usable.</summary>
        public void Dispose() => Handle.Dispose();

        private static HapticModel Open(ModelOptions* options)
        {
            LibraryAgreement.Require();
            IntPtr opened;
            NativeCall.Check(NativeMethods.ModelOpen(options, &opened));
            return new HapticModel(opened);
        }

        private static string ReadSpace(IntPtr model)
        {
            IntPtr space;
            NativeCall.Check(NativeMethods.ModelSpace(model, &space));
            return NativeCall.Text(space);
        }

        private static HapticLabel[] ReadLabels(IntPtr model)
        {
            uint count;
            NativeCall.Check(NativeMethods.ModelLabelCount(model, &count));
            var labels = new HapticLabel[count];
            for (uint index = 0; index < count; ++index)
            {
                var info = new LabelInfo { StructSize = (uint)sizeof(LabelInfo) };
                NativeCall.Check(NativeMethods.ModelLabel(model, index, &info));
                labels[index] = new HapticLabel(info, (int)index);
            }
            return labels;
        }

        private static HapticTier[] ReadTiers(IntPtr model)
        {
            uint count;
            NativeCall.Check(NativeMethods.ModelTierCount(model, &count));
            var tiers = new HapticTier[count];
            for (uint index = 0; index < count; ++index)
            {
                var info = new TierInfo { StructSize = (uint)sizeof(TierInfo) };
                NativeCall.Check(NativeMethods.ModelTier(model, index, &info));
                tiers[index] = new HapticTier(info, (int)index);
            }
            return tiers;
        }
    }

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
        /// <exception cref="HaptoFlowException">There is no such tier, or a graph is not usable or too slow.</exception>
        public HapticGenerator(OnnxRuntime runtime, HapticModel model, string? tier = null)
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
                };
                NativeCall.Check(NativeMethods.GeneratorCreate(&options, &opened));
            }
            GC.KeepAlive(runtime);
            GC.KeepAlive(model);
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
