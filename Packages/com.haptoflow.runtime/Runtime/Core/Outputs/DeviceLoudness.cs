#nullable enable
using System;
using HaptoFlow.Native;

namespace HaptoFlow.Outputs
{
    /// <summary>The loudness law of the native library: the part of a device's range at which an acceleration is
    /// played. Straight proportion would leave most textures where a motor does not move.</summary>
    internal static unsafe class DeviceLoudness
    {
        /// <summary>The part of the device's range, 0 to below 1, of a peak amplitude in m/s^2.</summary>
        public static float Share(HapticForm form, float amplitudeMps2)
        {
            float share;
            NativeCall.Check(NativeMethods.DeviceShare((int)form, amplitudeMps2, &share));
            return share;
        }
    }

    /// <summary>A source's wave at the level of a device that plays waveforms, by a gain that follows the wave's
    /// envelope. Main thread; no garbage.</summary>
    internal sealed unsafe class DeviceWave : IWaveSource, IDisposable
    {
        /// <summary>Delay of the wave, in s.</summary>
        public const double LatencySeconds = 0.001;

        private readonly IWaveSource source;
        private readonly NativeHandle handle;
        private bool keepsTrueLevel;

        public DeviceWave(IWaveSource source)
        {
            this.source = source;
            IntPtr opened;
            NativeCall.Check(NativeMethods.DeviceWaveCreate(WaveHistory.RateHz, &opened));
            handle = new NativeHandle(opened, NativeMethods.DeviceWaveClose);
        }

        /// <summary>True to pass the wave on as it is.</summary>
        public bool KeepsTrueLevel
        {
            get => keepsTrueLevel;
            set
            {
                if (value != keepsTrueLevel)
                {
                    keepsTrueLevel = value;
                    handle.Check(NativeMethods.DeviceWaveReset(handle.Value));
                }
            }
        }

        /// <summary>Full scale of the source: the acceleration that a sample of 1 represents, in m/s^2.</summary>
        public float FullScaleMps2 { get; set; } = (float)HapticEngineOptions.DefaultFullScaleMps2;

        /// <inheritdoc/>
        public bool IsStopped => source.IsStopped;

        /// <inheritdoc/>
        public void Render(Span<float> samples)
        {
            source.Render(samples);
            if (keepsTrueLevel)
            {
                return;
            }
            fixed (float* wave = samples)
            {
                handle.Check(NativeMethods.DeviceWaveProcess(
                    handle.Value, wave, (ulong)samples.Length, FullScaleMps2));
            }
        }

        /// <inheritdoc/>
        public void Dispose() => handle.Dispose();
    }
}
