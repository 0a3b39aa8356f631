#nullable enable
using System;
using System.Text;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>Formats of clip files, all of them JSON.</summary>
    public enum HapticClipFormat
    {
        /// <summary>.haptic of Meta and Lofelt.</summary>
        Haptic = 0,

        /// <summary>.ahap of Apple.</summary>
        Ahap = 1,

        /// <summary>.hjif of MPEG-I haptics.</summary>
        Hjif = 2,
    }

    /// <summary>Figures of a clip.</summary>
    public readonly struct HapticClipInfo
    {
        internal HapticClipInfo(in NativeClipInfo info)
        {
            Format = (HapticClipFormat)info.Format;
            DurationSeconds = info.DurationSeconds;
            AmplitudePoints = (int)info.AmplitudePoints;
            FrequencyPoints = (int)info.FrequencyPoints;
            Transients = (int)info.Transients;
            LargestAmplitude = info.LargestAmplitude;
            Title = NativeCall.Text(info.Title);
            Description = NativeCall.Text(info.Description);
            Editor = NativeCall.Text(info.Editor);
            Omitted = NativeCall.Text(info.Omitted);
        }

        /// <summary>Format of the file that was read.</summary>
        public HapticClipFormat Format { get; }

        /// <summary>Duration in seconds.</summary>
        public double DurationSeconds { get; }

        /// <summary>Number of points of the amplitude.</summary>
        public int AmplitudePoints { get; }

        /// <summary>Number of points of the frequency.</summary>
        public int FrequencyPoints { get; }

        /// <summary>Number of taps and edges.</summary>
        public int Transients { get; }

        /// <summary>Largest amplitude, 0 to 1 of a device's range.</summary>
        public float LargestAmplitude { get; }

        /// <summary>Title in the file; may be empty.</summary>
        public string Title { get; }

        /// <summary>Description in the file; may be empty.</summary>
        public string Description { get; }

        /// <summary>Program that wrote the file; may be empty.</summary>
        public string Editor { get; }

        /// <summary>What the file has and the clip has not, in words; empty for nothing.</summary>
        public string Omitted { get; }
    }

    /// <summary>A vibration as the tools of designers describe one: amplitude and frequency over time, and transients.
    /// Read from a clip file, or made of a wave; the native library holds it. Immutable: any thread. Freed when it is
    /// disposed, collected, or its application domain ends; a voice that plays it plays on.</summary>
    public sealed unsafe class HapticClipFile : IDisposable
    {
        /// <summary>Upper limit of the gain of <see cref="HapticVoice.PlayClip"/>.</summary>
        public const float MaximumGain = 4f;

        private HapticClipFile(IntPtr opened)
        {
            Handle = new NativeHandle(opened, NativeMethods.ClipClose);
            var info = new NativeClipInfo { StructSize = (uint)sizeof(NativeClipInfo) };
            Handle.Check(NativeMethods.ClipDescribe(opened, &info));
            Info = new HapticClipInfo(info);
        }

        /// <summary>Figures of the clip; they stay readable after it was disposed.</summary>
        public HapticClipInfo Info { get; }

        internal NativeHandle Handle { get; }

        /// <summary>The handle for a call in which null has a meaning of its own.</summary>
        /// <exception cref="HaptoFlowException">The clip was disposed.</exception>
        internal IntPtr OpenValue => Handle.Value != IntPtr.Zero
            ? Handle.Value
            : throw new HaptoFlowException(HaptoFlowStatus.InvalidArgument, "the clip was disposed");

        /// <summary>Reads a clip file; the format is recognised by its keys.</summary>
        /// <param name="text">The whole file in UTF-8, 16 MiB at most.</param>
        /// <exception cref="HaptoFlowException">There is no library, or the text is not a clip; the message names the
        /// key.</exception>
        public static HapticClipFile Read(ReadOnlySpan<byte> text)
        {
            LibraryAgreement.Require();
            IntPtr opened;
            // The library refuses a null pointer, which an empty span has, with words about pointers.
            byte nothing = 0;
            fixed (byte* bytes = text)
            {
                NativeCall.Check(NativeMethods.ClipRead(bytes != null ? bytes : &nothing, (ulong)text.Length, &opened));
            }
            return new HapticClipFile(opened);
        }

        /// <summary>Makes the clip of a wave. Takes about 2 ms for each second of it.</summary>
        /// <param name="waveMps2">In m/s^2, 600 s at most; samples that are not finite count as 0.</param>
        /// <param name="sampleRateHz">A multiple of 2000, 2000 to 192000.</param>
        /// <param name="title">What files say of the clip; may be empty, as the other texts.</param>
        /// <param name="isLoop">True for a wave that goes on at its beginning.</param>
        /// <exception cref="HaptoFlowException">There is no library, the wave is empty or too long, or the rate is out
        /// of range.</exception>
        public static HapticClipFile FromWave(ReadOnlySpan<float> waveMps2, int sampleRateHz, string title = "",
            string description = "", string source = "", bool isLoop = false)
        {
            LibraryAgreement.Require();
            IntPtr opened;
            fixed (float* wave = waveMps2)
            fixed (byte* titleText = NativeCall.Utf8(title), descriptionText = NativeCall.Utf8(description))
            fixed (byte* sourceText = NativeCall.Utf8(source))
            {
                var options = new NativeClipOptions
                {
                    StructSize = (uint)sizeof(NativeClipOptions),
                    // 0 would be the library's usual rate.
                    SampleRateHz = (uint)Math.Max(1, sampleRateHz),
                    WaveMps2 = wave,
                    SampleCount = (ulong)waveMps2.Length,
                    IsLoop = isLoop ? 1u : 0u,
                    Title = (IntPtr)titleText,
                    Description = (IntPtr)descriptionText,
                    Source = (IntPtr)sourceText,
                };
                NativeCall.Check(NativeMethods.ClipCreate(&options, &opened));
            }
            return new HapticClipFile(opened);
        }

        /// <summary>The text of a clip file. Points are left out while amplitudes stay within 0.5 dB.</summary>
        /// <param name="date">Day of the file's creation, which .hjif names.</param>
        /// <exception cref="HaptoFlowException">The clip was disposed, or there is no such format.</exception>
        public string Write(HapticClipFormat format, DateTime date)
        {
            byte[] day = NativeCall.Utf8(date.ToString("yyyy-MM-dd", System.Globalization.CultureInfo.InvariantCulture));
            fixed (byte* dayText = day)
            {
                ulong length;
                Handle.Check(NativeMethods.ClipWrite(Handle.Value, (int)format, dayText, null, 0, &length));
                var text = new byte[checked((int)length)];
                fixed (byte* bytes = text)
                {
                    Handle.Check(NativeMethods.ClipWrite(Handle.Value, (int)format, dayText, bytes, length, &length));
                }
                return Encoding.UTF8.GetString(text);
            }
        }

        /// <summary>Reads amplitude, 0 to 1, and frequency, in Hz, evenly from the clip's start to its end.</summary>
        /// <param name="frequencyHz">As long as <paramref name="amplitude"/>.</param>
        /// <exception cref="ArgumentException">The lengths differ.</exception>
        /// <exception cref="HaptoFlowException">The clip was disposed.</exception>
        public void Curves(Span<float> amplitude, Span<float> frequencyHz)
        {
            if (amplitude.Length != frequencyHz.Length)
            {
                throw new ArgumentException($"{amplitude.Length} amplitudes and {frequencyHz.Length} frequencies were " +
                    "asked for; give spans of one length", nameof(frequencyHz));
            }
            fixed (float* amplitudes = amplitude, frequencies = frequencyHz)
            {
                Handle.Check(
                    NativeMethods.ClipCurves(Handle.Value, (uint)amplitude.Length, amplitudes, frequencies));
            }
        }

        /// <summary>The clip as a vibration in m/s^2.</summary>
        /// <param name="sampleRateHz">2000 to 192000.</param>
        /// <exception cref="HaptoFlowException">The clip was disposed, or the rate is out of range.</exception>
        public float[] Wave(double sampleRateHz)
        {
            ulong count;
            Handle.Check(NativeMethods.ClipWave(Handle.Value, sampleRateHz, null, 0, &count));
            var wave = new float[checked((int)count)];
            fixed (float* samples = wave)
            {
                Handle.Check(NativeMethods.ClipWave(Handle.Value, sampleRateHz, samples, count, &count));
            }
            return wave;
        }

        /// <summary>Frees the clip. A voice that plays it plays on.</summary>
        public void Dispose() => Handle.Dispose();
    }
}
