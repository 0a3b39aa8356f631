#nullable enable
using System;
using HaptoFlow.Recordings;

namespace HaptoFlow.Native
{
    /// <summary>Calls haptoflow_learn_material with pinned inputs.</summary>
    internal static unsafe class NativeLearning
    {
        /// <param name="context">A handle to a <see cref="LearningProgress"/>.</param>
        /// <exception cref="HaptoFlowException">Nothing can be learnt from the recording, or learning was
        /// cancelled.</exception>
        public static (string Material, string Report) Run(OnnxRuntime runtime, HapticModel model, Recording recording,
            LearningOptions options, HapticCancellation cancellation, IntPtr context)
        {
            (double x, double y) = recording.ConstantVelocityMps ?? (0.0, 0.0);
            IntPtr opened;
            fixed (byte* tier = options.Tier != null ? NativeCall.Utf8(options.Tier) : null)
            fixed (byte* name = NativeCall.Utf8(options.Name), category = NativeCall.Utf8(options.Category))
            fixed (byte* description = NativeCall.Utf8(options.Description))
            fixed (byte* licence = NativeCall.Utf8(options.Licence), recordings = NativeCall.Utf8(recording.Provenance))
            fixed (float* acceleration = recording.AccelerationMps2, velocity = recording.VelocityMps)
            fixed (float* force = recording.ForceNewtons, waveVectors = options.WaveVectorsPerMillimetre)
            {
                var native = new NativeLearningOptions
                {
                    StructSize = (uint)sizeof(NativeLearningOptions),
                    AxisCount = (uint)recording.AxisCount,
                    Runtime = runtime.Handle.Value,
                    Model = model.Handle.Value,
                    Tier = (IntPtr)tier,
                    Name = (IntPtr)name,
                    Category = (IntPtr)category,
                    Description = (IntPtr)description,
                    Licence = (IntPtr)licence,
                    AccelerationMps2 = acceleration,
                    SampleCount = (ulong)recording.SampleCount,
                    SampleRateHz = recording.SampleRateHz,
                    VelocityMps = velocity,
                    ForceNewtons = force,
                    ConstantForceNewtons = recording.ConstantForceNewtons ?? 0.0,
                    Seed = options.Seed,
                    SecondsLimit = options.SecondsLimit,
                    Progress = LearningProgress.Function,
                    ProgressContext = context,
                    Cancellation = cancellation.Handle.Value,
                    WaveVectors = waveVectors,
                    Recordings = (IntPtr)recordings,
                };
                native.ConstantVelocityMps[0] = x;
                native.ConstantVelocityMps[1] = y;
                NativeCall.Check(NativeMethods.LearnMaterial(&native, &opened));
            }
            GC.KeepAlive(runtime);
            GC.KeepAlive(model);
            GC.KeepAlive(cancellation);
            using var learning = new NativeHandle(opened, NativeMethods.LearningClose);
            IntPtr material;
            IntPtr report;
            NativeCall.Check(NativeMethods.LearningMaterial(learning.Value, &material));
            NativeCall.Check(NativeMethods.LearningReport(learning.Value, &report));
            return (NativeCall.Text(material), NativeCall.Text(report));
        }
    }
}
