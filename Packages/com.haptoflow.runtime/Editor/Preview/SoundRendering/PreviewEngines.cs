#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>The engine that previews are rendered with: made when it is needed, kept while it serves. One thread
    /// at a time, one that can wait for the disk and for networks.</summary>
    internal sealed class PreviewEngines : IDisposable
    {
        // The command line's default, so that both render alike.
        private const double LeadMs = 8.0;

        // Two are compared; what a slider leaves behind makes room for what comes.
        private const int KeptMaterials = 4;

        private OnnxRuntime? runtime;
        private byte[]? file;
        private HapticModel? model;
        private HapticEngine? engine;
        // Of the engine: which text is where, the oldest first.
        private readonly List<(string Text, int Index)> materials = new List<(string, int)>();
        private bool used;
        private (HapticQuality Quality, ulong Seed) options;

        /// <summary>Engines made so far: each takes as long to make as a stroke takes to render.</summary>
        public int Made { get; private set; }

        /// <param name="fresh">No voice was opened in it: what it renders depends on stroke and seed alone.</param>
        /// <exception cref="HaptoFlowException">A library is not there, or the file is no usable model.</exception>
        public HapticEngine Engine(byte[] modelFile, HapticQuality quality, ulong seed, bool fresh)
        {
            HapticModel opened = Model(modelFile);
            if (engine == null || options != (quality, seed) || (fresh && used))
            {
                CloseEngine();
                engine = new HapticEngine(runtime!, opened, new HapticEngineOptions
                {
                    Quality = quality,
                    UpdateRateHz = Stroke.UpdateRateHz,
                    FullScaleMps2 = PreviewSound.FullScaleMps2,
                    Seed = seed,
                    WithoutWorker = true,
                    FixedLeadMs = LeadMs,
                });
                options = (quality, seed);
                ++Made;
            }
            used = true;
            return engine;
        }

        /// <summary>Where the engine that was made last knows a learnt material, which is registered there first, or
        /// put in the place of one that nobody hears any more.</summary>
        /// <param name="text">Of a material file.</param>
        /// <exception cref="HaptoFlowException">It is none, or was learnt for another model.</exception>
        public int MaterialIndex(string text)
        {
            int known = materials.FindIndex(each => each.Text == text);
            if (known >= 0)
            {
                return materials[known].Index;
            }
            int index;
            if (materials.Count < KeptMaterials)
            {
                index = engine!.RegisterMaterial(text);
            }
            else
            {
                index = materials[0].Index;
                engine!.ReplaceMaterial(index, text);
                materials.RemoveAt(0);
            }
            materials.Add((text, index));
            return index;
        }

        /// <summary>One tier alone, for measuring. The caller closes it.</summary>
        /// <exception cref="HaptoFlowException">A library is not there, or the file is no usable model.</exception>
        public HapticGenerator Generator(byte[] modelFile, string tier)
        {
            HapticModel opened = Model(modelFile);
            return new HapticGenerator(runtime!, opened, tier);
        }

        /// <summary>The material embedding of the model's first label.</summary>
        public float[] Embedding(byte[] modelFile) => Model(modelFile).Embedding(0);

        /// <summary>Native memory goes now, not when the collector comes by.</summary>
        public void Dispose()
        {
            CloseModel();
            runtime?.Dispose();
            runtime = null;
        }

        private HapticModel Model(byte[] modelFile)
        {
            if (model == null || !ReferenceEquals(file, modelFile))
            {
                CloseModel();
                runtime ??= OnnxRuntime.Open();
                model = HapticModel.Open(modelFile);
                file = modelFile;
            }
            return model;
        }

        private void CloseEngine()
        {
            engine?.Dispose();
            engine = null;
            materials.Clear();
            used = false;
        }

        private void CloseModel()
        {
            CloseEngine();
            model?.Dispose();
            model = null;
            file = null;
        }
    }
}
