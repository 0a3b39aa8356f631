#nullable enable
using System;
using System.Runtime.InteropServices;

namespace HaptoFlow.Native
{
    /// <summary>The functions of haptoflow.h; the header states from which threads each may be called and what it
    /// blocks on.</summary>
    [Preserve]
    internal static unsafe class NativeMethods
    {
#if UNITY_IOS && !UNITY_EDITOR
        private const string Library = "__Internal";
        private const string OnnxRuntime = "__Internal";
#else
        private const string Library = "audioplugin_haptoflow";
        private const string OnnxRuntime = "onnxruntime";
#endif

        /// <summary>ONNX Runtime's entry point: the plugin obtains every other function from it.</summary>
        [DllImport(OnnxRuntime, EntryPoint = "OrtGetApiBase")]
        public static extern IntPtr OrtGetApiBase();
        [DllImport(Library, EntryPoint = "haptoflow_version")]
        public static extern IntPtr Version();
        [DllImport(Library, EntryPoint = "haptoflow_status_name")]
        public static extern IntPtr StatusName(int status);
        [DllImport(Library, EntryPoint = "haptoflow_last_message")]
        public static extern IntPtr LastMessage();
        [DllImport(Library, EntryPoint = "haptoflow_struct_size")]
        public static extern int StructSize(byte* name, uint* bytes);

        [DllImport(Library, EntryPoint = "haptoflow_runtime_open")]
        public static extern int RuntimeOpen(RuntimeOptions* options, IntPtr* runtime);
        [DllImport(Library, EntryPoint = "haptoflow_runtime_close")]
        public static extern int RuntimeClose(IntPtr* runtime);

        [DllImport(Library, EntryPoint = "haptoflow_cancellation_create")]
        public static extern int CancellationCreate(IntPtr* cancellation);
        [DllImport(Library, EntryPoint = "haptoflow_cancellation_cancel")]
        public static extern int CancellationCancel(IntPtr cancellation);
        [DllImport(Library, EntryPoint = "haptoflow_cancellation_close")]
        public static extern int CancellationClose(IntPtr* cancellation);

        [DllImport(Library, EntryPoint = "haptoflow_model_open")]
        public static extern int ModelOpen(ModelOptions* options, IntPtr* model);
        [DllImport(Library, EntryPoint = "haptoflow_model_close")]
        public static extern int ModelClose(IntPtr* model);
        [DllImport(Library, EntryPoint = "haptoflow_model_header")]
        public static extern int ModelHeader(IntPtr model, IntPtr* headerJson);
        [DllImport(Library, EntryPoint = "haptoflow_model_describe")]
        public static extern int ModelDescribe(IntPtr model, ModelInfo* info);
        [DllImport(Library, EntryPoint = "haptoflow_model_label_count")]
        public static extern int ModelLabelCount(IntPtr model, uint* count);
        [DllImport(Library, EntryPoint = "haptoflow_model_label")]
        public static extern int ModelLabel(IntPtr model, uint index, LabelInfo* info);
        [DllImport(Library, EntryPoint = "haptoflow_model_embedding")]
        public static extern int ModelEmbedding(IntPtr model, uint index, float* embedding);
        [DllImport(Library, EntryPoint = "haptoflow_model_nearest_label")]
        public static extern int ModelNearestLabel(IntPtr model, float* embedding, uint* index);
        [DllImport(Library, EntryPoint = "haptoflow_model_space")]
        public static extern int ModelSpace(IntPtr model, IntPtr* space);
        [DllImport(Library, EntryPoint = "haptoflow_model_tier_count")]
        public static extern int ModelTierCount(IntPtr model, uint* count);
        [DllImport(Library, EntryPoint = "haptoflow_model_tier")]
        public static extern int ModelTier(IntPtr model, uint index, TierInfo* info);

        [DllImport(Library, EntryPoint = "haptoflow_material_read")]
        public static extern int MaterialRead(byte* json, ulong length, IntPtr* material);
        [DllImport(Library, EntryPoint = "haptoflow_material_close")]
        public static extern int MaterialClose(IntPtr* material);
        [DllImport(Library, EntryPoint = "haptoflow_material_describe")]
        public static extern int MaterialDescribe(IntPtr material, MaterialInfo* info);
        [DllImport(Library, EntryPoint = "haptoflow_material_embedding")]
        public static extern int MaterialEmbedding(IntPtr material, float* embedding);

        [DllImport(Library, EntryPoint = "haptoflow_generator_create")]
        public static extern int GeneratorCreate(GeneratorOptions* options, IntPtr* generator);
        [DllImport(Library, EntryPoint = "haptoflow_generator_close")]
        public static extern int GeneratorClose(IntPtr* generator);
        [DllImport(Library, EntryPoint = "haptoflow_generator_generate")]
        public static extern int GeneratorGenerate(IntPtr generator, Batch* batch, float* segmentsMps2);

        [DllImport(Library, EntryPoint = "haptoflow_engine_create")]
        public static extern int EngineCreate(EngineOptions* options, IntPtr* engine);
        [DllImport(Library, EntryPoint = "haptoflow_engine_close")]
        public static extern int EngineClose(IntPtr* engine);
        [DllImport(Library, EntryPoint = "haptoflow_engine_set_quality")]
        public static extern int EngineSetQuality(IntPtr engine, int quality);
        [DllImport(Library, EntryPoint = "haptoflow_engine_register_material")]
        public static extern int EngineRegisterMaterial(IntPtr engine, byte* json, ulong length, uint* index);
        [DllImport(Library, EntryPoint = "haptoflow_engine_replace_material")]
        public static extern int EngineReplaceMaterial(IntPtr engine, uint index, byte* json, ulong length);
        [DllImport(Library, EntryPoint = "haptoflow_engine_material")]
        public static extern int EngineMaterial(IntPtr engine, uint index, LabelInfo* info);
        [DllImport(Library, EntryPoint = "haptoflow_engine_step")]
        public static extern int EngineStep(IntPtr engine);
        [DllImport(Library, EntryPoint = "haptoflow_engine_get_statistics")]
        public static extern int EngineGetStatistics(IntPtr engine, EngineStatistics* statistics);
        [DllImport(Library, EntryPoint = "haptoflow_engine_last_failure")]
        public static extern int EngineLastFailure(IntPtr engine, byte* text, ulong capacity, ulong* length);
        [DllImport(Library, EntryPoint = "haptoflow_engine_tier_times")]
        public static extern int EngineTierTimes(IntPtr engine, uint index, TierTimes* times);

        [DllImport(Library, EntryPoint = "haptoflow_relief_create")]
        public static extern int ReliefCreate(ReliefOptions* options, uint* relief);
        [DllImport(Library, EntryPoint = "haptoflow_relief_destroy")]
        public static extern int ReliefDestroy(uint* relief);
        [DllImport(Library, EntryPoint = "haptoflow_relief_heights_of_normals")]
        public static extern int ReliefHeightsOfNormals(
            float* normals, uint columns, uint rows, float* sizeMetres, uint isTiled, float* heightsMetres);

        [DllImport(Library, EntryPoint = "haptoflow_voice_create")]
        public static extern int VoiceCreate(IntPtr engine, double sampleRateHz, ulong* voice);
        [DllImport(Library, EntryPoint = "haptoflow_voice_destroy")]
        public static extern int VoiceDestroy(ulong* voice);
        [DllImport(Library, EntryPoint = "haptoflow_voice_publish")]
        public static extern int VoicePublish(ulong voice, ContactState* state);
        [DllImport(Library, EntryPoint = "haptoflow_voice_render")]
        public static extern int VoiceRender(
            ulong voice, float* interleaved, uint frameCount, uint channelCount, int channel, double sampleRateHz);
        [DllImport(Library, EntryPoint = "haptoflow_voices_render")]
        public static extern int VoicesRender(
            ulong* voices, uint voiceCount, float* interleaved, uint frameCount, uint channelCount, int channel,
            double sampleRateHz);
        [DllImport(Library, EntryPoint = "haptoflow_voice_set_strength")]
        public static extern int VoiceSetStrength(ulong voice, float strength);
        [DllImport(Library, EntryPoint = "haptoflow_voice_set_ceiling")]
        public static extern int VoiceSetCeiling(ulong voice, float ceiling);
        [DllImport(Library, EntryPoint = "haptoflow_voice_set_muted")]
        public static extern int VoiceSetMuted(ulong voice, uint muted);
        [DllImport(Library, EntryPoint = "haptoflow_voice_set_paused")]
        public static extern int VoiceSetPaused(ulong voice, uint paused);
        [DllImport(Library, EntryPoint = "haptoflow_voice_panic")]
        public static extern int VoicePanic(ulong voice);
        [DllImport(Library, EntryPoint = "haptoflow_panic")]
        public static extern int Panic();
        [DllImport(Library, EntryPoint = "haptoflow_voice_get_statistics")]
        public static extern int VoiceGetStatistics(ulong voice, VoiceStatistics* statistics);
        [DllImport(Library, EntryPoint = "haptoflow_voice_set_delay")]
        public static extern int VoiceSetDelay(ulong voice, double seconds);
        [DllImport(Library, EntryPoint = "haptoflow_voice_set_signal")]
        public static extern int VoiceSetSignal(ulong voice, double frequencyHz, double amplitudeMps2);
        [DllImport(Library, EntryPoint = "haptoflow_voice_signal_statistics")]
        public static extern int VoiceSignalStatistics(ulong voice, SignalStatistics* statistics);
        [DllImport(Library, EntryPoint = "haptoflow_voice_set_actuator")]
        public static extern int VoiceSetActuator(ulong voice, byte* profile, ulong length);
        [DllImport(Library, EntryPoint = "haptoflow_voice_set_exposure_guard")]
        public static extern int VoiceSetExposureGuard(ulong voice, uint isOn, float actuatorGain);
        [DllImport(Library, EntryPoint = "haptoflow_voice_exposure")]
        public static extern int VoiceExposure(ulong voice, HapticExposure* exposure);
        [DllImport(Library, EntryPoint = "haptoflow_voice_effect_statistics")]
        public static extern int VoiceEffectStatistics(ulong voice, int effect, EffectStatistics* statistics);
        [DllImport(Library, EntryPoint = "haptoflow_voice_place")]
        public static extern int VoicePlace(ulong voice, uint* place);
        [DllImport(Library, EntryPoint = "haptoflow_voice_set_listen")]
        public static extern int VoiceSetListen(ulong voice, uint isOn);

        [DllImport(Library, EntryPoint = "haptoflow_clip_create")]
        public static extern int ClipCreate(NativeClipOptions* options, IntPtr* clip);
        [DllImport(Library, EntryPoint = "haptoflow_clip_read")]
        public static extern int ClipRead(byte* text, ulong length, IntPtr* clip);
        [DllImport(Library, EntryPoint = "haptoflow_clip_close")]
        public static extern int ClipClose(IntPtr* clip);
        [DllImport(Library, EntryPoint = "haptoflow_clip_describe")]
        public static extern int ClipDescribe(IntPtr clip, NativeClipInfo* info);
        [DllImport(Library, EntryPoint = "haptoflow_clip_write")]
        public static extern int ClipWrite(
            IntPtr clip, int format, byte* date, byte* text, ulong capacity, ulong* length);
        [DllImport(Library, EntryPoint = "haptoflow_clip_curves")]
        public static extern int ClipCurves(IntPtr clip, uint count, float* amplitude, float* frequencyHz);
        [DllImport(Library, EntryPoint = "haptoflow_clip_wave")]
        public static extern int ClipWave(
            IntPtr clip, double sampleRateHz, float* waveMps2, ulong capacity, ulong* sampleCount);
        [DllImport(Library, EntryPoint = "haptoflow_voice_play_clip")]
        public static extern int VoicePlayClip(ulong voice, IntPtr clip, float gain, uint isLoop);

        [DllImport(Library, EntryPoint = "haptoflow_wave_features_create")]
        public static extern int WaveFeaturesCreate(WaveFeaturesOptions* options, IntPtr* features);
        [DllImport(Library, EntryPoint = "haptoflow_wave_features_close")]
        public static extern int WaveFeaturesClose(IntPtr* features);
        [DllImport(Library, EntryPoint = "haptoflow_wave_features_reset")]
        public static extern int WaveFeaturesReset(IntPtr features);
        [DllImport(Library, EntryPoint = "haptoflow_wave_features_set_range")]
        public static extern int WaveFeaturesSetRange(
            IntPtr features, double minimumFrequencyHz, double maximumFrequencyHz);
        [DllImport(Library, EntryPoint = "haptoflow_wave_features_process")]
        public static extern int WaveFeaturesProcess(
            IntPtr features, float* waveMps2, ulong sampleCount, NativeWaveFrame* frames, ulong capacity,
            ulong* frameCount);

        [DllImport(Library, EntryPoint = "haptoflow_device_share")]
        public static extern int DeviceShare(int kind, float amplitudeMps2, float* share);
        [DllImport(Library, EntryPoint = "haptoflow_device_wave_create")]
        public static extern int DeviceWaveCreate(double sampleRateHz, IntPtr* wave);
        [DllImport(Library, EntryPoint = "haptoflow_device_wave_close")]
        public static extern int DeviceWaveClose(IntPtr* wave);
        [DllImport(Library, EntryPoint = "haptoflow_device_wave_reset")]
        public static extern int DeviceWaveReset(IntPtr wave);
        [DllImport(Library, EntryPoint = "haptoflow_device_wave_process")]
        public static extern int DeviceWaveProcess(
            IntPtr wave, float* samples, ulong sampleCount, float fullScaleMps2);

        [DllImport(Library, EntryPoint = "haptoflow_recording_read")]
        public static extern int RecordingRead(NativeRecordingOptions* options, IntPtr* recording);
        [DllImport(Library, EntryPoint = "haptoflow_recording_get_info")]
        public static extern int RecordingGetInfo(IntPtr recording, NativeRecordingInfo* info);
        [DllImport(Library, EntryPoint = "haptoflow_recording_wave")]
        public static extern int RecordingWave(IntPtr recording, float* waveMps2, ulong waveCount);
        [DllImport(Library, EntryPoint = "haptoflow_resample")]
        public static extern int Resample(float* samples, ulong sampleCount, double sampleRateHz, float* wave,
            ulong waveCount, double waveRateHz);
        [DllImport(Library, EntryPoint = "haptoflow_recording_close")]
        public static extern int RecordingClose(IntPtr* recording);

        [DllImport(Library, EntryPoint = "haptoflow_learn_material")]
        public static extern int LearnMaterial(NativeLearningOptions* options, IntPtr* learning);
        [DllImport(Library, EntryPoint = "haptoflow_learning_results")]
        public static extern int LearningResults(IntPtr learning, IntPtr* material, IntPtr* report);
        [DllImport(Library, EntryPoint = "haptoflow_learning_close")]
        public static extern int LearningClose(IntPtr* learning);
    }
}
