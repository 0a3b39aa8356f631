#nullable enable
using System;
using System.Text;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>Selects the tier.</summary>
    public enum HapticQuality
    {
        /// <summary>Measures the model's tiers on this machine while nothing touches and takes the most accurate one
        /// within the budget (by the figures in the model's header); switches to a faster one when the machine falls
        /// behind, and back when it recovers. Needs a worker.</summary>
        Auto = 0,

        /// <summary>The tier "draft"; where the model has none, its first.</summary>
        Draft = 1,

        /// <summary>The tier "standard"; where the model has none, its default tier.</summary>
        Standard = 2,

        // 3 was Fine, which assets of earlier versions may hold (HapticQualityExtensions).

        /// <summary>The tier "sketch", which plays without a network, for machines that are too slow for one; where the
        /// model has none, its first tier.</summary>
        Sketch = 4,
    }

    /// <summary>For fields in which assets keep a quality.</summary>
    public static class HapticQualityExtensions
    {
        /// <summary>The quality itself; Standard in place of a number that is no quality, as an asset of an earlier
        /// version may hold it. Any thread.</summary>
        public static HapticQuality OrStandard(this HapticQuality quality) =>
            quality is HapticQuality.Auto or HapticQuality.Draft or HapticQuality.Standard or HapticQuality.Sketch
                ? quality
                : HapticQuality.Standard;
    }

    /// <summary>Options of an engine. Zeros select the native library's defaults.</summary>
    public struct HapticEngineOptions
    {
        /// <summary>Default full scale. Strokes of people over the labels of the shipped model stay below the limiter's
        /// knee (0.7) except for less than one sample in a thousand.</summary>
        public const double DefaultFullScaleMps2 = 200.0;

        /// <summary>Default rate of contact states, in Hz: the refresh rate of common headsets.</summary>
        public const double DefaultUpdateRateHz = 72.0;

        /// <summary>Selects the tier.</summary>
        public HapticQuality Quality;

        /// <summary>Rate of contact states, 1 to 10000 Hz; 0 for <see cref="DefaultUpdateRateHz"/>.</summary>
        public double UpdateRateHz;

        /// <summary>Share of the time between two contact states that inference may take, above 0 to 1; 0 for 0.25.
        /// </summary>
        public double BudgetShare;

        /// <summary>Full scale: the acceleration that is +-1 in the output, in m/s^2; 0 for <see
        /// cref="DefaultFullScaleMps2"/>.</summary>
        public double FullScaleMps2;

        /// <summary>Seed of all noise.</summary>
        public ulong Seed;

        /// <summary>True for an engine without worker thread: the caller calls <see cref="HapticEngine.Step"/> and sets
        /// a fixed quality. For rendering outside real time.</summary>
        public bool WithoutWorker;

        /// <summary>Lead, above 0 to 50 ms; 0 for the shortest that this machine sustains. With a fixed lead an engine
        /// without worker is deterministic.</summary>
        public double FixedLeadMs;

        /// <summary>Cancels the creation of the engine; null for none.</summary>
        public HapticCancellation? Cancellation;
    }

    /// <summary>All voices of one model, and the worker thread that generates their segments. The thread sleeps while
    /// nothing slides. Any thread except an audio callback.</summary>
    public sealed unsafe class HapticEngine : IDisposable
    {
        /// <summary>Number of materials that one engine can hold in addition to its model's labels.</summary>
        public const int MaximumMaterials = 64;

        private readonly NativeHandle handle;

        /// <summary>Loads the tiers of the quality, all of them for automatic quality, and starts the worker. Blocks
        /// while ONNX Runtime optimises the graphs; runtime and model may be disposed afterwards.</summary>
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
            };
            IntPtr opened;
            NativeCall.Check(NativeMethods.EngineCreate(&native, &opened));
            GC.KeepAlive(runtime);
            GC.KeepAlive(model);
            GC.KeepAlive(options.Cancellation);
            handle = new NativeHandle(opened, NativeMethods.EngineClose);
        }

        /// <summary>Changes the quality from the next segment on.</summary>
        public void SetQuality(HapticQuality quality) =>
            handle.Check(NativeMethods.EngineSetQuality(handle.Value, (int)quality));

        /// <summary>Registers a material in addition to the model's labels until the engine is disposed. Takes
        /// milliseconds; voices never wait for it. Any thread except an audio callback.</summary>
        /// <param name="json">The text of a material file.</param>
        /// <returns>The material's index for a <see cref="LabelBlend"/>; it follows those of the model's
        /// labels.</returns>
        /// <exception cref="HaptoFlowException">The text is not a material file, the material was learnt for another
        /// model, or <see cref="MaximumMaterials"/> are registered.</exception>
        public int RegisterMaterial(string json)
        {
            uint index;
            byte[] text = NativeCall.Utf8(json);
            fixed (byte* bytes = text)
            {
                handle.Check(
                    NativeMethods.EngineRegisterMaterial(handle.Value, bytes, (ulong)text.Length - 1, &index));
            }
            return (int)index;
        }

        /// <summary>Replaces a registered material from the next published state on. Where this fails, the old one
        /// stays. Takes milliseconds; voices never wait for it. Any thread except an audio callback.</summary>
        /// <param name="index">The index that <see cref="RegisterMaterial"/> returned.</param>
        /// <param name="json">The text of a material file.</param>
        /// <exception cref="HaptoFlowException">As for <see cref="RegisterMaterial"/>, or no material is registered at
        /// the index.</exception>
        public void ReplaceMaterial(int index, string json)
        {
            byte[] text = NativeCall.Utf8(json);
            fixed (byte* bytes = text)
            {
                handle.Check(NativeMethods.EngineReplaceMaterial(
                    handle.Value, checked((uint)index), bytes, (ulong)text.Length - 1));
            }
        }

        /// <summary>Name, category and properties of a registered material. Makes garbage.</summary>
        /// <param name="index">The index that <see cref="RegisterMaterial"/> returned.</param>
        /// <exception cref="HaptoFlowException">No material is registered at the index.</exception>
        public HapticLabel Material(int index)
        {
            var info = new LabelInfo { StructSize = (uint)sizeof(LabelInfo) };
            handle.Check(NativeMethods.EngineMaterial(handle.Value, checked((uint)index), &info));
            // Its texts are the engine's.
            var material = new HapticLabel(info, index);
            GC.KeepAlive(this);
            return material;
        }

        /// <summary>Runs one round of inference for all voices that need a segment. For engines without worker; any
        /// thread that may block.</summary>
        public void Step() => handle.Check(NativeMethods.EngineStep(handle.Value));

        /// <summary>Statistics since the engine was created.</summary>
        public EngineStatistics Statistics()
        {
            var statistics = new EngineStatistics { StructSize = (uint)sizeof(EngineStatistics) };
            handle.Check(NativeMethods.EngineGetStatistics(handle.Value, &statistics));
            return statistics;
        }

        /// <summary>Text of the newest failure, of a round of inference or of the worker itself; empty before the
        /// first. Makes garbage.</summary>
        public string LastFailure()
        {
            ulong length;
            handle.Check(NativeMethods.EngineLastFailure(handle.Value, null, 0, &length));
            // A longer message that replaces it meanwhile is truncated.
            var text = new byte[length + 1];
            fixed (byte* bytes = text)
            {
                handle.Check(NativeMethods.EngineLastFailure(handle.Value, bytes, (ulong)text.Length, &length));
            }
            int end = Array.IndexOf(text, (byte)0);
            return Encoding.UTF8.GetString(text, 0, end < 0 ? text.Length : end);
        }

        /// <param name="tier">Index into the model's tiers.</param>
        public TierTimes Times(int tier)
        {
            var times = new TierTimes { StructSize = (uint)sizeof(TierTimes) };
            handle.Check(NativeMethods.EngineTierTimes(handle.Value, checked((uint)tier), &times));
            return times;
        }

        /// <summary>Opens a voice: the signal of one stylus tip. Blocks while another voice is opened or closed, never
        /// for inference.</summary>
        /// <param name="sampleRateHz">Sample rate of the output, 8000 to 192000 Hz. It may change later.</param>
        /// <exception cref="HaptoFlowException">The rate is out of range, or the process has 64 voices.</exception>
        public HapticVoice OpenVoice(double sampleRateHz)
        {
            ulong voice;
            handle.Check(NativeMethods.VoiceCreate(handle.Value, sampleRateHz, &voice));
            return new HapticVoice(voice);
        }

        /// <summary>Ends the worker and closes the voices; blocks being rendered are finished first.</summary>
        public void Dispose() => handle.Dispose();
    }

    /// <summary>ONNX Runtime for the native library. One per process is enough.</summary>
    public sealed unsafe class OnnxRuntime : IDisposable
    {
        private OnnxRuntime(IntPtr opened) => Handle = new NativeHandle(opened, NativeMethods.RuntimeClose);

        internal NativeHandle Handle { get; }

        /// <summary>Opens the ONNX Runtime of this platform's package (onnxruntime). Any thread that may block for the
        /// disk.</summary>
        /// <exception cref="HaptoFlowException">A library is missing or belongs to another version of the
        /// package, or ONNX Runtime is older than version 1.16.</exception>
        public static OnnxRuntime Open() => NativeCall.OrMissing(() =>
        {
            LibraryAgreement.Require();
            var options = new RuntimeOptions
            {
                StructSize = (uint)sizeof(RuntimeOptions),
                OrtApiBase = NativeMethods.OrtGetApiBase(),
            };
            IntPtr opened;
            NativeCall.Check(NativeMethods.RuntimeOpen(&options, &opened));
            return new OnnxRuntime(opened);
        });

        /// <summary>Version of the native library, for example "0.2.0". Any thread.</summary>
        /// <exception cref="HaptoFlowException">The library is missing.</exception>
        public static string LibraryVersion() => NativeCall.OrMissing(() => NativeCall.Text(NativeMethods.Version()));

        /// <summary>Frees the handle; engines and generators created with it stay usable.</summary>
        public void Dispose() => Handle.Dispose();
    }

    /// <summary>Cancels the loads whose options reference it, also those that start later. Any thread except an audio
    /// callback.</summary>
    public sealed unsafe class HapticCancellation : IDisposable
    {
        /// <exception cref="HaptoFlowException">The library is missing, or memory is exhausted.</exception>
        public HapticCancellation()
        {
            LibraryAgreement.Require();
            IntPtr opened;
            NativeCall.Check(NativeMethods.CancellationCreate(&opened));
            Handle = new NativeHandle(opened, NativeMethods.CancellationClose);
        }

        internal NativeHandle Handle { get; }

        /// <summary>Cancels permanently: the loads end with <see cref="HaptoFlowStatus.Cancelled"/>, those under way as
        /// soon as ONNX Runtime allows.</summary>
        public void Cancel() => Handle.Check(NativeMethods.CancellationCancel(Handle.Value));

        /// <summary>Frees the handle; loads under way continue.</summary>
        public void Dispose() => Handle.Dispose();
    }
}
