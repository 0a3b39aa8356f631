using System;
using System.IO;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;

namespace HaptoFlow.Tests.Support
{
    internal static class RepositoryFiles
    {
        public static string Root { get; } = Path.GetFullPath(Path.Combine(Path.GetDirectoryName(ThisFile())!, "..", "..", ".."));

        public static string DefaultModel => In("Packages", "com.haptoflow.runtime", "Runtime", "Models", "default.haptoflow");

        /// <summary>The folder with the built native library: HAPTOFLOW_NATIVE_DIR, else build/native.</summary>
        public static string NativeFolder =>
            Environment.GetEnvironmentVariable("HAPTOFLOW_NATIVE_DIR") is { Length: > 0 } folder ? folder : In("build", "native");

        public static string OnnxRuntime => RuntimeInformation.IsOSPlatform(OSPlatform.Windows)
            ? In("node_modules", "com.github.asus4.onnxruntime", "Plugins", "Windows", "x64", "onnxruntime.dll")
            : RuntimeInformation.IsOSPlatform(OSPlatform.OSX)
                ? In("node_modules", "com.github.asus4.onnxruntime", "Plugins", "macOS", "arm64", "libonnxruntime.dylib")
                : In("node_modules", "com.github.asus4.onnxruntime", "Plugins", "Linux", "x64", "libonnxruntime.so");

        /// <summary>Recorded strokes, which are not part of the repository; null where they are missing.</summary>
        public static string? RealStrokes
        {
            get
            {
                string path = Path.Combine(Root, "..", "shared", "strokes", "vr-pen-on-surface", "strokes.csv");
                return File.Exists(path) ? path : null;
            }
        }

        public static string In(params string[] parts) => Path.Combine(Root, Path.Combine(parts));

        private static string ThisFile([CallerFilePath] string path = "") => path;
    }

    internal static class SampleFiles
    {
        public static string In(string sample, string name) => sample.EndsWith("Study")
            ? RepositoryFiles.In("Packages", "com.haptoflow.studies", "Samples~", sample, name)
            : RepositoryFiles.In("Samples~", sample, name);

        /// <summary>The scene of a sample. That of Workshop is a scene of the repository's own project; packing adds it to
        /// the sample.</summary>
        public static string Scene(string sample) => sample == "Workshop"
            ? RepositoryFiles.In("Assets", "Workshop.unity")
            : In(sample, sample + ".unity");
    }
}
