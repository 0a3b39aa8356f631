#nullable enable
using System.Collections.Generic;

namespace HaptoFlow.Native
{
    /// <summary>Refuses a native library that belongs to another version of the package, or to another build of the
    /// same version with other structs.</summary>
    internal static unsafe class LibraryAgreement
    {
        /// <summary>The package's version, which the library has, too.</summary>
        public const string Version = "0.2.0";

        private static volatile bool isProven;

        /// <summary>Every struct that crosses the border, by its name in haptoflow.h, with its size here in
        /// bytes.</summary>
        public static IReadOnlyDictionary<string, int> Structs { get; } = new Dictionary<string, int>
        {
            ["haptoflow_runtime_options"] = sizeof(RuntimeOptions),
            ["haptoflow_model_options"] = sizeof(ModelOptions),
            ["haptoflow_model_info"] = sizeof(ModelInfo),
            ["haptoflow_label_info"] = sizeof(LabelInfo),
            ["haptoflow_tier_info"] = sizeof(TierInfo),
            ["haptoflow_material_info"] = sizeof(MaterialInfo),
            ["haptoflow_generator_options"] = sizeof(GeneratorOptions),
            ["haptoflow_batch"] = sizeof(Batch),
            ["haptoflow_engine_options"] = sizeof(EngineOptions),
            ["haptoflow_tier_times"] = sizeof(TierTimes),
            ["haptoflow_engine_statistics"] = sizeof(EngineStatistics),
            ["haptoflow_relief_options"] = sizeof(ReliefOptions),
            ["haptoflow_contact_state"] = sizeof(ContactState),
            ["haptoflow_effect_statistics"] = sizeof(EffectStatistics),
            ["haptoflow_voice_statistics"] = sizeof(VoiceStatistics),
            ["haptoflow_signal_statistics"] = sizeof(SignalStatistics),
            ["haptoflow_exposure"] = sizeof(HapticExposure),
            ["haptoflow_clip_options"] = sizeof(NativeClipOptions),
            ["haptoflow_clip_info"] = sizeof(NativeClipInfo),
            ["haptoflow_wave_features_options"] = sizeof(WaveFeaturesOptions),
            ["haptoflow_wave_frame"] = sizeof(NativeWaveFrame),
            ["haptoflow_recording_file"] = sizeof(NativeRecordingFile),
            ["haptoflow_recording_options"] = sizeof(NativeRecordingOptions),
            ["haptoflow_track"] = sizeof(NativeTrack),
            ["haptoflow_recording_info"] = sizeof(NativeRecordingInfo),
            ["haptoflow_learning_options"] = sizeof(NativeLearningOptions),
        };

        /// <summary>Returns where the library has the version and the struct sizes of this assembly. Any thread; a
        /// library that agreed is not asked again.</summary>
        /// <exception cref="HaptoFlowException">It has not: <see cref="HaptoFlowStatus.LibraryMismatch"/>; or there is
        /// no library.</exception>
        public static void Require()
        {
            if (isProven)
            {
                return;
            }
            string version = OnnxRuntime.LibraryVersion();
            if (version != Version)
            {
                throw Disagreement($"is of version {version}, and the package's C# scripts are of version {Version}");
            }
            foreach (KeyValuePair<string, int> expected in Structs)
            {
                uint bytes = SizeInLibrary(expected.Key);
                if (bytes != expected.Value)
                {
                    throw Disagreement(bytes == 0
                        ? $"does not say how large its struct {expected.Key} is"
                        : $"has {bytes} bytes in its struct {expected.Key}, and the package's C# scripts have " +
                            $"{expected.Value}");
                }
            }
            isProven = true;
        }

        /// <summary>0 where the library does not know the struct.</summary>
        private static uint SizeInLibrary(string name)
        {
            uint bytes = 0;
            fixed (byte* text = NativeCall.Utf8(name))
            {
                return NativeMethods.StructSize(text, &bytes) == (int)HaptoFlowStatus.Ok ? bytes : 0;
            }
        }

        private static HaptoFlowException Disagreement(string what) => new HaptoFlowException(
            HaptoFlowStatus.LibraryMismatch,
            $"The native library audioplugin_haptoflow {what}: install the package com.haptoflow.runtime again and " +
                $"restart Unity, which keeps a library that it loaded until it ends.");
    }
}
