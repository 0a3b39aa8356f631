#nullable enable
using System;
using System.Runtime.InteropServices;

namespace HaptoFlow.Native
{
    // The structures of haptoflow.h, field by field and blittable.

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal struct RuntimeOptions
    {
        public uint StructSize;
        public IntPtr OrtApiBase;
        public IntPtr LibraryPath;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal struct ModelOptions
    {
        public uint StructSize;
        public IntPtr Bytes;
        public ulong ByteCount;
        public IntPtr Path;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ModelInfo
    {
        public uint StructSize;
        public IntPtr Name;
        public IntPtr Description;
        public IntPtr Statement;
        public IntPtr Recordings;
        public IntPtr Licence;
        public IntPtr Commit;
        public IntPtr Created;
        public fixed double SpeedMps[2];
        public fixed double ForceNewtons[2];
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal struct LabelInfo
    {
        public uint StructSize;
        public uint IsPeriodic;
        public IntPtr Name;
        public IntPtr Category;
        public double StiffnessNewtonsPerMetre;
        public double FrictionCoefficient;
        public double WavelengthMetres;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal struct TierInfo
    {
        public uint StructSize;
        public int Steps;
        public IntPtr Name;
        public IntPtr Kind;
        public IntPtr AccuracyJson;
        public IntPtr CostJson;
        public int Solver;
        public uint IsDefault;
        public long ParameterCount;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal unsafe struct MaterialInfo
    {
        public uint StructSize;
        public IntPtr Name;
        public IntPtr Category;
        public IntPtr Description;
        public IntPtr Space;
        public IntPtr Statement;
        public IntPtr Recordings;
        public IntPtr Licence;
        public IntPtr Created;
        public double Seconds;
        public double StiffnessNewtonsPerMetre;
        public double LevelOffsetDecibels;
        public fixed double SpeedMps[2];
        public fixed double ForceNewtons[2];
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal struct GeneratorOptions
    {
        public uint StructSize;
        public uint MaximumBatch;
        public IntPtr Runtime;
        public IntPtr Model;
        public IntPtr Tier;
        public IntPtr Cancellation;
        public double ProbeLimitMs;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal unsafe struct Batch
    {
        public uint StructSize;
        public uint Count;
        public float* Embeddings;
        public float* Motions;
        public float* PreviousMps2;
        public float* Noise;
        public float* RibPhases;
        public float* OwnLevelsMps2;
        public float* LatentNoise;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal struct EngineOptions
    {
        public uint StructSize;
        public int Quality;
        public IntPtr Runtime;
        public IntPtr Model;
        public double UpdateRateHz;
        public double BudgetShare;
        public double FullScaleMps2;
        public ulong Seed;
        public uint BatchVoices;
        public uint WithoutWorker;
        public double FixedLeadMs;
        public IntPtr Cancellation;
        public double ProbeLimitMs;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal unsafe struct ReliefOptions
    {
        public uint StructSize;
        public uint Columns;
        public uint Rows;
        public uint IsTiled;
        public float* HeightsMetres;
        public fixed float SizeMetres[2];
        public float DepthMetres;
        public float TipRadiusMetres;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeClipOptions
    {
        public uint StructSize;
        public uint SampleRateHz;
        public float* WaveMps2;
        public ulong SampleCount;
        public uint IsLoop;
        public IntPtr Title;
        public IntPtr Description;
        public IntPtr Source;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal struct NativeClipInfo
    {
        public uint StructSize;
        public int Format;
        public double DurationSeconds;
        public uint AmplitudePoints;
        public uint FrequencyPoints;
        public uint Transients;
        public float LargestAmplitude;
        public IntPtr Title;
        public IntPtr Description;
        public IntPtr Editor;
        public IntPtr Omitted;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal struct WaveFeaturesOptions
    {
        public uint StructSize;
        public uint SampleRateHz;
        public double FrameSeconds;
        public double MinimumFrequencyHz;
        public double MaximumFrequencyHz;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal struct NativeWaveFrame
    {
        public ulong FirstSample;
        public uint SampleCount;
        public float Intensity;
        public float CentroidHz;
        public float FrequencyHz;
        public float AmplitudeMps2;
        public float TransientOffsetSeconds;
        public float TransientAmplitudeMps2;
        public float TransientFrequencyHz;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal struct NativeRecordingFile
    {
        public IntPtr Name;
        public IntPtr Bytes;
        public ulong ByteCount;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeRecordingOptions
    {
        public uint StructSize;
        public uint FileCount;
        public IntPtr Path;
        public NativeRecordingFile* Files;
        public double FullScaleMps2;
        public uint WithoutSamples;
        public uint NeedsMotionAndForce;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeTrack
    {
        public double* Seconds;
        public double* Values;
        public ulong Count;
        public ulong Width;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeRecordingInfo
    {
        public uint StructSize;
        public uint AxisCount;
        public double SampleRateHz;
        public ulong SampleCount;
        public float* AccelerationMps2;
        public float* VelocityMps;
        public float* ForceNewtons;
        public fixed double ConstantVelocityMps[2];
        public double ConstantForceNewtons;
        public NativeTrack Acceleration;
        public NativeTrack Motion;
        public NativeTrack Force;
        public uint MotionIsPosition;
        public uint Reserved;
        public IntPtr Label;
        public IntPtr Licence;
        public IntPtr Source;
        public IntPtr MotionPath;
        public IntPtr Notes;
        public IntPtr MaterialName;
        public IntPtr Provenance;
    }

    [Preserve, StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeLearningOptions
    {
        public uint StructSize;
        public uint Reserved;
        public IntPtr Recording;
        public double SpeedMps;
        public double ForceNewtons;
        public IntPtr Runtime;
        public IntPtr Model;
        public IntPtr Tier;
        public IntPtr Name;
        public IntPtr Category;
        public IntPtr Description;
        public IntPtr Licence;
        public ulong Seed;
        public double SecondsLimit;
        public IntPtr Progress;
        public IntPtr ProgressContext;
        public IntPtr Cancellation;
        public float* WaveVectors;
        public IntPtr Label;
    }
}
