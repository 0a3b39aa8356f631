#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Runtime.InteropServices;
using HaptoFlow.Native;

namespace HaptoFlow.Recordings
{
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

            try
            {
                LibraryAgreement.Require();
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
                using var handle = new NativeHandle(opened, NativeMethods.RecordingClose);
                var info = new NativeRecordingInfo { StructSize = (uint)sizeof(NativeRecordingInfo) };
                NativeCall.Check(NativeMethods.RecordingGetInfo(handle.Value, &info));
                return Made(Path.GetFileNameWithoutExtension(path), info);
            }
            catch (Exception error) when (NativeCall.IsMissing(error))
            {
                throw NativeCall.Missing(error);
            }
            finally
            {
                pins.ForEach(pin => pin.Free());
            }
        }

        private static Recording Made(string name, in NativeRecordingInfo info)
        {
            int count = checked((int)info.SampleCount);
            int axes = (int)info.AxisCount;
            double x = info.ConstantVelocityMps[0];
            return new Recording(name, info.SampleRateHz, axes, Copied(info.AccelerationMps2, axes * count)!)
            {
                VelocityMps = Copied(info.VelocityMps, 2 * count),
                ConstantVelocityMps = double.IsNaN(x) ? ((double, double)?)null : (x, info.ConstantVelocityMps[1]),
                ForceNewtons = Copied(info.ForceNewtons, count),
                ConstantForceNewtons =
                    double.IsNaN(info.ConstantForceNewtons) ? (double?)null : info.ConstantForceNewtons,
                Label = NativeCall.Text(info.Label),
                Licence = NativeCall.Text(info.Licence),
                Source = NativeCall.Text(info.Source),
                MaterialName = NativeCall.Text(info.MaterialName),
                Provenance = NativeCall.Text(info.Provenance),
                Remarks = NativeCall.Text(info.Notes).Split(new[] { '\n' }, StringSplitOptions.RemoveEmptyEntries),
            };
        }

        private static float[]? Copied(float* samples, int count) =>
            samples == null ? null : new ReadOnlySpan<float>(samples, count).ToArray();
    }
}
