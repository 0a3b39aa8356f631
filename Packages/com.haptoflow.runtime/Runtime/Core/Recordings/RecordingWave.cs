#nullable enable
using System;
using HaptoFlow.Native;

namespace HaptoFlow.Recordings
{
    /// <summary>A recording as learning hears it, with the sensor's noise that learning removes. Any thread.</summary>
    internal static unsafe class RecordingWave
    {
        /// <summary>Sample rate in Hz.</summary>
        public const double RateHz = 2000.0;

        /// <summary>The beginning of a recording in the form that is learnt: one axis, 10 to 1000 Hz, in m/s^2. Gaps are
        /// silent.</summary>
        public static float[] Of(Recording recording, double maximumSeconds)
        {
            int count = Math.Min(recording.SampleCount, (int)(maximumSeconds * recording.SampleRateHz));
            var wave = new float[LengthAt(RateHz, count, recording.SampleRateHz)];
            fixed (float* acceleration = recording.AccelerationMps2, written = wave)
            {
                NativeCall.Check(NativeMethods.RecordingWave(acceleration, (ulong)count, (uint)recording.AxisCount,
                    recording.SampleRateHz, written, (ulong)wave.Length));
            }
            return wave;
        }

        /// <summary>A waveform at another rate, 1000 to 192000 Hz, without delay.</summary>
        public static float[] Resampled(float[] samples, double fromHz, double toHz)
        {
            var wave = new float[LengthAt(toHz, samples.Length, fromHz)];
            fixed (float* given = samples, written = wave)
            {
                NativeCall.Check(NativeMethods.Resample(given, (ulong)samples.Length, fromHz, written,
                    (ulong)wave.Length, toHz));
            }
            return wave;
        }

        private static int LengthAt(double rateHz, int count, double ofRateHz) =>
            Math.Max(1, (int)Math.Floor(count * rateHz / ofRateHz + 1e-9));
    }
}
