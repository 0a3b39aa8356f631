#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Runtime.InteropServices;
using HaptoFlow.Native;

namespace HaptoFlow.Recordings
{
    /// <summary>A recording of a material: acceleration with its motion and force. Immutable: any thread. The library
    /// holds its samples.</summary>
    public sealed unsafe class Recording
    {
        private readonly NativeHandle handle;
        private readonly NativeRecordingInfo info;

        private Recording(Recording other, double? speedMps, double? forceNewtons)
        {
            handle = other.handle;
            info = other.info;
            Name = other.Name;
            Remarks = other.Remarks;
            ConstantVelocityMps = other.KnowsSpeed || speedMps == null
                ? other.ConstantVelocityMps
                : (speedMps.Value, 0.0);
            ConstantForceNewtons = other.KnowsForce ? other.ConstantForceNewtons : forceNewtons;
        }

        internal Recording(string name, NativeHandle handle)
        {
            this.handle = handle;
            Name = name;
            var read = new NativeRecordingInfo { StructSize = (uint)sizeof(NativeRecordingInfo) };
            handle.Check(NativeMethods.RecordingGetInfo(handle.Value, &read));
            info = read;
            if (!double.IsNaN(read.ConstantVelocityMps[0]))
            {
                ConstantVelocityMps = (read.ConstantVelocityMps[0], read.ConstantVelocityMps[1]);
            }
            if (!double.IsNaN(read.ConstantForceNewtons))
            {
                ConstantForceNewtons = read.ConstantForceNewtons;
            }
            Remarks = NativeCall.Text(info.Notes).Split(new[] { '\n' }, StringSplitOptions.RemoveEmptyEntries);
        }

        /// <summary>Name of the file without extension.</summary>
        public string Name { get; }

        /// <summary>Sample rate of the acceleration, 1000 to 192000 Hz.</summary>
        public double SampleRateHz => info.SampleRateHz;

        /// <summary>Number of axes, 1 or 3.</summary>
        public int AxisCount => (int)info.AxisCount;

        /// <summary>Name of the recorded material; empty where unknown.</summary>
        public string Label => Text(info.Label);

        /// <summary>Licence of the recording; empty where unknown.</summary>
        public string Licence => Text(info.Licence);

        /// <summary>What a material learnt from this recording is called where nobody names it: the label or else the
        /// file's name, in lower case.</summary>
        public string MaterialName => Text(info.MaterialName);

        /// <summary>What was ignored or corrected during reading, one sentence each.</summary>
        public IReadOnlyList<string> Remarks { get; }

        /// <summary>Number of samples per axis.</summary>
        public int SampleCount => checked((int)info.SampleCount);

        /// <summary>Duration in seconds.</summary>
        public double Seconds => SampleCount / SampleRateHz;

        /// <summary>True where the files or <see cref="With"/> tell the speed.</summary>
        public bool KnowsSpeed => info.VelocityMps != null || ConstantVelocityMps != null;

        /// <summary>True where the files or <see cref="With"/> tell the force.</summary>
        public bool KnowsForce => info.ForceNewtons != null || ConstantForceNewtons != null;

        /// <summary>True where speed and force are known, so that a material can be learnt from it.</summary>
        public bool KnowsMotion => KnowsSpeed && KnowsForce;

        /// <summary>Velocity in m/s along the two axes of the surface; null where unknown or not constant.</summary>
        public (double X, double Y)? ConstantVelocityMps { get; }

        /// <summary>Force in N; null where unknown or not constant.</summary>
        public double? ConstantForceNewtons { get; }

        /// <summary>Velocity in m/s along the surface's two axes; zero where unknown.</summary>
        public (double X, double Y) VelocityAt(int sample) => info.VelocityMps != null
            ? (At(info.VelocityMps, 2 * sample, 2 * SampleCount), At(info.VelocityMps, 2 * sample + 1, 2 * SampleCount))
            : ConstantVelocityMps ?? (0.0, 0.0);

        /// <summary>Force in N; zero where unknown.</summary>
        public double ForceAt(int sample) => info.ForceNewtons != null
            ? At(info.ForceNewtons, sample, SampleCount)
            : ConstantForceNewtons ?? 0.0;

        /// <summary>A copy with a speed and a force where the files contain none.</summary>
        /// <param name="speedMps">Speed along the first axis; null to leave it unknown.</param>
        /// <param name="forceNewtons">Force in N; null to leave it unknown.</param>
        public Recording With(double? speedMps, double? forceNewtons) => new Recording(this, speedMps, forceNewtons);

        /// <summary>The first seconds of the recording as learning takes them: one axis, 10 to 1000 Hz, in m/s^2, at
        /// <see cref="Waves.RateHz"/>. The sensor's noise is still in them, and gaps are silent.</summary>
        internal float[] Wave(double maximumSeconds)
        {
            int count = Math.Min(SampleCount, (int)(maximumSeconds * SampleRateHz));
            var wave = new float[Waves.LengthAt(Waves.RateHz, count, SampleRateHz)];
            fixed (float* written = wave)
            {
                handle.Check(NativeMethods.RecordingWave(handle.Value, written, (ulong)wave.Length));
            }
            return wave;
        }

        /// <summary>Sets what learning needs of the recording, which must stay referenced until the call ends. The library
        /// takes the constants only where the files have no motion or no force.</summary>
        internal void Give(ref NativeLearningOptions options)
        {
            options.Recording = handle.Value;
            options.SpeedMps = ConstantVelocityMps?.X ?? 0.0;
            options.ForceNewtons = ConstantForceNewtons ?? 0.0;
        }

        private string Text(IntPtr utf8)
        {
            string text = NativeCall.Text(utf8);
            GC.KeepAlive(handle);
            return text;
        }

        private double At(float* values, int index, int count)
        {
            if ((uint)index >= (uint)count)
            {
                throw new ArgumentOutOfRangeException(nameof(index));
            }
            float value = values[index];
            GC.KeepAlive(handle);
            return float.IsNaN(value) ? 0.0 : value;
        }
    }

    /// <summary>Reads recordings: a CSV table or a WAV file, and the files beside it. The formats are described in
    /// own-materials.md. Any thread that may block for the disk.</summary>
    public static unsafe class RecordingReader
    {
        /// <summary>Reads a file with the files NAME.json, recordings.json and motion file beside it.</summary>
        /// <param name="path">Path of a .csv, .wav or .w64 file.</param>
        /// <param name="fullScaleMps2">The acceleration of +-1 for a WAV file, in place of its sidecar's; null for the
        /// sidecar's.</param>
        /// <exception cref="HaptoFlowException">Names the file, the line and column or the key, what was found and what
        /// is expected. Also where the native library is missing.</exception>
        public static Recording Read(string path, double? fullScaleMps2 = null) =>
            Read(path, Array.Empty<KeyValuePair<string, byte[]>>(), fullScaleMps2);

        /// <summary>Reads bytes, for recordings that are part of an application.</summary>
        /// <param name="name">Name of the recording among the files, which ends in .csv, .wav or .w64.</param>
        /// <param name="files">The recording and what lies beside it, by their names with ending and without folder.
        /// </param>
        /// <param name="fullScaleMps2">As for a file on disk.</param>
        /// <exception cref="HaptoFlowException">As for a file on disk.</exception>
        public static Recording Read(
            string name, IReadOnlyDictionary<string, byte[]> files, double? fullScaleMps2 = null) =>
            Read(name, files.ToArray(), fullScaleMps2);

        private static Recording Read(string path, KeyValuePair<string, byte[]>[] files, double? fullScaleMps2)
        {
            var pins = new List<GCHandle>();
            IntPtr Pinned(byte[] bytes)
            {
                pins.Add(GCHandle.Alloc(bytes, GCHandleType.Pinned));
                return pins[pins.Count - 1].AddrOfPinnedObject();
            }

            LibraryAgreement.Require();
            try
            {
                NativeRecordingFile[] given = Array.ConvertAll(files, file => new NativeRecordingFile
                {
                    Name = Pinned(NativeCall.Utf8(file.Key)),
                    Bytes = Pinned(file.Value),
                    ByteCount = (ulong)file.Value.Length,
                });
                IntPtr opened;
                fixed (NativeRecordingFile* first = given)
                {
                    var options = new NativeRecordingOptions
                    {
                        StructSize = (uint)sizeof(NativeRecordingOptions),
                        FileCount = (uint)given.Length,
                        Path = Pinned(NativeCall.Utf8(path)),
                        Files = first,
                        FullScaleMps2 = fullScaleMps2 ?? 0.0,
                    };
                    NativeCall.Check(NativeMethods.RecordingRead(&options, &opened));
                }
                return new Recording(
                    Path.GetFileNameWithoutExtension(path), new NativeHandle(opened, NativeMethods.RecordingClose));
            }
            finally
            {
                pins.ForEach(pin => pin.Free());
            }
        }
    }

    /// <summary>Waveforms at other rates. Any thread.</summary>
    internal static unsafe class Waves
    {
        /// <summary>The rate in Hz at which learning hears a recording.</summary>
        public const double RateHz = 2000.0;

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

        public static int LengthAt(double rateHz, int count, double ofRateHz) =>
            Math.Max(1, (int)Math.Floor(count * rateHz / ofRateHz + 1e-9));
    }
}
