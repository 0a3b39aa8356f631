#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>Creates the engine that previews are rendered with, and keeps it as long as model, quality and seed
    /// stay the same. One thread at a time, never the main thread: loading and inference take long.</summary>
    internal sealed class PreviewEngines : IDisposable
    {
        // The command line's default lead, so that both render the same samples.
        private const double LeadMs = 8.0;

        private OnnxRuntime? runtime;
        private byte[]? file;
        private HapticModel? model;
        private HapticEngine? engine;
        private int? material;
        private bool used;
        private (HapticQuality Quality, ulong Seed) options;
        private (ReliefHeights Heights, HapticReliefMap Map)? relief;

        private OnnxRuntime Runtime => runtime ??= OnnxRuntime.Open();

        /// <summary>The engine for these options.</summary>
        /// <param name="fresh">True for an engine without an earlier voice, whose samples depend only on stroke and
        /// seed.</param>
        /// <exception cref="HaptoFlowException">A library is missing, or the model cannot be used.</exception>
        public HapticEngine Engine(byte[] modelFile, HapticQuality quality, ulong seed, bool fresh)
        {
            HapticModel opened = Model(modelFile);
            if (engine == null || options != (quality, seed) || (fresh && used))
            {
                CloseEngine();
                engine = new HapticEngine(Runtime, opened, new HapticEngineOptions
                {
                    Quality = quality,
                    UpdateRateHz = Stroke.UpdateRateHz,
                    FullScaleMps2 = PreviewSound.FullScaleMps2,
                    Seed = seed,
                    WithoutWorker = true,
                    FixedLeadMs = LeadMs,
                });
                options = (quality, seed);
            }
            used = true;
            return engine;
        }

        /// <summary>Gives a learnt material to the engine that was created last, in place of the one before: sounds are
        /// rendered one after the other.</summary>
        /// <param name="text">The text of a material file.</param>
        /// <returns>Index of the material in the engine.</returns>
        /// <exception cref="HaptoFlowException">The text is no material file, or learnt for another model.</exception>
        public int Register(string text)
        {
            if (material.HasValue)
            {
                engine!.ReplaceMaterial(material.Value, text);
            }
            else
            {
                material = engine!.RegisterMaterial(text);
            }
            return material.Value;
        }

        /// <summary>The library's number of a relief, whose map is kept until another one or none is asked for; 0 for
        /// none.</summary>
        /// <exception cref="HaptoFlowException">The library refuses the relief.</exception>
        public uint Relief(PreviewRelief? asked)
        {
            if (relief.HasValue && !ReferenceEquals(relief.Value.Heights, asked?.Heights))
            {
                CloseRelief();
            }
            if (asked == null)
            {
                return 0;
            }
            try
            {
                relief ??= (asked.Heights, asked.Heights.MakeMap());
            }
            catch (HaptoFlowException refusal)
            {
                throw new HaptoFlowException(
                    refusal.Status, $"the relief {asked.Name} cannot be felt: {refusal.Message}");
            }
            return relief.Value.Map.Number;
        }

        /// <summary>A generator of one tier, for timing. The caller disposes it.</summary>
        /// <exception cref="HaptoFlowException">A library is missing, or the model cannot be used.</exception>
        public HapticGenerator Generator(byte[] modelFile, string tier) =>
            new HapticGenerator(Runtime, Model(modelFile), tier);

        /// <summary>The model, which is kept as long as it is asked for.</summary>
        /// <exception cref="HaptoFlowException">The library is missing, or the model cannot be used.</exception>
        public HapticModel Model(byte[] modelFile)
        {
            if (model == null || !ReferenceEquals(file, modelFile))
            {
                CloseModel();
                model = HapticModel.Open(modelFile);
                file = modelFile;
            }
            return model;
        }

        public void Dispose()
        {
            CloseModel();
            CloseRelief();
            runtime?.Dispose();
            runtime = null;
        }

        private void CloseRelief()
        {
            relief?.Map.Dispose();
            relief = null;
        }

        private void CloseEngine()
        {
            engine?.Dispose();
            engine = null;
            material = null;
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
