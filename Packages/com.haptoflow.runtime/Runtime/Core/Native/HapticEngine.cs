#nullable enable
using System;
using System.Text;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>Which tier generates.</summary>
    public enum HapticQuality
    {
        /// <summary>Measures the model's tiers on this machine while nothing touches, takes the most accurate that fits
        /// the budget (by the figures in the model's header), a faster one when the machine cannot keep up, and a more
        /// accurate one when it can again.</summary>
        Auto = 0,

        /// <summary>The tier "draft"; where the model has none, its first.</summary>
        Draft = 1,

        /// <summary>The tier "standard"; where the model has none, its default tier.</summary>
        Standard = 2,

        /// <summary>The tier "fine"; where the model has none, its most accurate.</summary>
        Fine = 3,
    }

    /// <summary>How an engine works. The defaults are the native library's.</summary>
    public struct HapticEngineOptions
    {
        /// <summary>So much that people's strokes over the shipped model's labels stay below the limiter's knee (0.7),
        /// but for less than one sample in a thousand.</summary>
        public const double DefaultFullScaleMps2 = 200.0;

        /// <summary>Which tier generates.</summary>
        public HapticQuality Quality;

        /// <summary>Contact states a second, 1 to 10000; 0 for 72.</summary>
        public double UpdateRateHz;

        /// <summary>Share of the time between two contact states that inference may take, above 0 to 1; 0 for 0.25.
        /// </summary>
        public double BudgetShare;

        /// <summary>What acceleration is +-1 in the output, in m/s^2; 0 for <see cref="DefaultFullScaleMps2"/>.
        /// </summary>
        public double FullScaleMps2;

        /// <summary>Key of all noise.</summary>
        public ulong Seed;

        /// <summary>No thread of its own: the caller calls <see cref="HapticEngine.Step"/>. For rendering outside of
        /// real time.</summary>
        public bool WithoutWorker;

        /// <summary>From a contact state to the first sample generated from it, above 0 to 50 ms; 0 for the shortest
        /// that holds on this machine. Fixed, an engine without worker is deterministic.</summary>
        public double FixedLeadMs;

        /// <summary>Ends the engine's creation early; null for none.</summary>
        public HapticCancellation? Cancellation;

        /// <summary>What a probe run of each graph may take for each 8 voices, above 0 to 3600000 ms; 0 for 10000 ms.
        /// </summary>
        public double ProbeLimitMs;
    }

    /// <summary>All voices of one model, and the one thread that generates for them. The thread sleeps while nothing
    /// slides. Methods may be called from any thread that is not an audio callback.</summary>
    public sealed unsafe class HapticEngine : IDisposable
    {
        /// <summary>Materials that one engine can hold beside its model's labels.</summary>
        public const int MaximumMaterials = 64;

        private readonly EngineHandle handle;

        /// <summary>Loads the tiers that the quality asks for, all of them for automatic quality, and starts the
        /// worker. Takes as long as ONNX Runtime needs to optimise
        /// the graphs; runtime and model may be disposed afterwards.</summary>
        /// <exception cref="HaptoFlowException">An option is out of range, a graph is not usable or too slow, or the
        /// creation was cancelled.</exception>
        public HapticEngine(OnnxRuntime runtime, HapticModel model, in HapticEngineOptions options)
        {
            var native = new EngineOptions
            {
                StructSize = (uint)sizeof(EngineOptions),
                Quality = (int)options.Quality,
                Runtime = runtime.Handle.Value,
                Model = model.Handle.Value,
                UpdateRateHz = options.UpdateRateHz,
                BudgetShare = options.BudgetShare,
                FullScaleMps2 = options.FullScaleMps2,
                Seed = options.Seed,
                WithoutWorker = options.WithoutWorker ? 1u : 0u,
                FixedLeadMs = options.FixedLeadMs,
                Cancellation = options.Cancellation?.Handle.Value ?? IntPtr.Zero,
                ProbeLimitMs = options.ProbeLimitMs,
            };
            IntPtr opened;
            NativeCall.Check(NativeMethods.EngineCreate(&native, &opened));
            GC.KeepAlive(runtime);
            GC.KeepAlive(model);
            GC.KeepAlive(options.Cancellation);
            handle = new EngineHandle(opened);
        }

        /// <summary>From the next segment on. A tier that this quality asks for and that is not loaded is loaded first:
        /// blocks for as long as ONNX Runtime needs.</summary>
        public void SetQuality(HapticQuality quality)
        {
            NativeCall.Check(NativeMethods.EngineSetQuality(handle.Value, (int)quality));
            GC.KeepAlive(this);
        }

        /// <summary>Registers a material beside the model's labels, which sound as before; it stays until the engine is
        /// disposed. Takes milliseconds; voices never wait for it. Any thread but an audio callback's.</summary>
        /// <param name="json">The text of a material file.</param>
        /// <returns>What a <see cref="LabelBlend"/> names it by: an index behind those of the model's labels.</returns>
        /// <exception cref="HaptoFlowException">The text is no material file, the material was learnt for another
        /// model, or <see cref="MaximumMaterials"/> are registered.</exception>
        public int RegisterMaterial(string json)
        {
            uint index;
            byte[] text = NativeCall.Utf8(json);
            fixed (byte* bytes = text)
            {
                NativeCall.Check(
                    NativeMethods.EngineRegisterMaterial(handle.Value, bytes, (ulong)text.Length - 1, &index));
            }
            GC.KeepAlive(this);
            return (int)index;
        }

        /// <summary>Puts another material in the place of a registered one: the next state that is published sounds
        /// like it. Where this fails, the old one stays. Takes milliseconds; voices never wait for it. Any thread but
        /// an audio callback's.</summary>
        /// <param name="index">What <see cref="RegisterMaterial"/> returned.</param>
        /// <param name="json">The text of a material file.</param>
        /// <exception cref="HaptoFlowException">As of <see cref="RegisterMaterial"/>, and where no material is
        /// registered at the index.</exception>
        public void ReplaceMaterial(int index, string json)
        {
            byte[] text = NativeCall.Utf8(json);
            fixed (byte* bytes = text)
            {
                NativeCall.Check(NativeMethods.EngineReplaceMaterial(
                    handle.Value, checked((uint)index), bytes, (ulong)text.Length - 1));
            }
            GC.KeepAlive(this);
        }

        /// <summary>How many materials are registered.</summary>
        public int MaterialCount()
        {
            uint count;
            NativeCall.Check(NativeMethods.EngineMaterialCount(handle.Value, &count));
            GC.KeepAlive(this);
            return (int)count;
        }

        /// <summary>What a registered material says of itself. Makes garbage.</summary>
        /// <param name="index">What <see cref="RegisterMaterial"/> returned.</param>
        /// <exception cref="HaptoFlowException">No material is registered at the index.</exception>
        public HapticLabel Material(int index)
        {
            var info = new LabelInfo { StructSize = (uint)sizeof(LabelInfo) };
            NativeCall.Check(NativeMethods.EngineMaterial(handle.Value, checked((uint)index), &info));
            var material = new HapticLabel(info, index);
            GC.KeepAlive(this);
            return material;
        }

        /// <summary>One round of inference for all voices that want one. Engines without worker only; any thread that
        /// can wait for a network.</summary>
        public void Step()
        {
            NativeCall.Check(NativeMethods.EngineStep(handle.Value));
            GC.KeepAlive(this);
        }

        /// <summary>What the engine did so far.</summary>
        public EngineStatistics Statistics()
        {
            var statistics = new EngineStatistics { StructSize = (uint)sizeof(EngineStatistics) };
            NativeCall.Check(NativeMethods.EngineGetStatistics(handle.Value, &statistics));
            GC.KeepAlive(this);
            return statistics;
        }

        /// <summary>Text of the newest failure, of a round of inference or of the worker itself; empty before the
        /// first. Makes garbage.</summary>
        public string LastFailure()
        {
            ulong length;
            NativeCall.Check(NativeMethods.EngineLastFailure(handle.Value, null, 0, &length));
            // A longer text that comes in between is cut.
            var text = new byte[length + 1];
            fixed (byte* bytes = text)
            {
                NativeCall.Check(NativeMethods.EngineLastFailure(handle.Value, bytes, (ulong)text.Length, &length));
            }
            GC.KeepAlive(this);
            int end = Array.IndexOf(text, (byte)0);
            return Encoding.UTF8.GetString(text, 0, end < 0 ? text.Length : end);
        }

        /// <param name="tier">Index into the model's tiers.</param>
        public TierTimes Times(int tier)
        {
            var times = new TierTimes { StructSize = (uint)sizeof(TierTimes) };
            NativeCall.Check(NativeMethods.EngineTierTimes(handle.Value, checked((uint)tier), &times));
            GC.KeepAlive(this);
            return times;
        }

        /// <summary>The signal of one stylus tip. Blocks while another voice is opened or closed, never for inference.
        /// </summary>
        /// <param name="sampleRateHz">Of the output, 8000 to 192000. It may change later.</param>
        /// <exception cref="HaptoFlowException">The rate is out of range, or 64 voices are open in this process.
        /// </exception>
        public HapticVoice OpenVoice(double sampleRateHz)
        {
            ulong voice;
            NativeCall.Check(NativeMethods.VoiceCreate(handle.Value, sampleRateHz, &voice));
            GC.KeepAlive(this);
            return new HapticVoice(voice);
        }

        /// <summary>Ends the worker and closes the voices; those being rendered finish their block first.</summary>
        public void Dispose() => handle.Dispose();
    }
}
