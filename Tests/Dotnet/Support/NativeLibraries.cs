using System;
using System.IO;
using System.Reflection;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;

namespace HaptoFlow.Tests.Support
{
    /// <summary>Resolves library names to files, as Unity's plugin importer does in the editor.</summary>
    internal static class NativeLibraries
    {
        [ModuleInitializer]
        internal static void Lead() =>
            NativeLibrary.SetDllImportResolver(typeof(HapticModel).Assembly, Resolve);

        private static IntPtr Resolve(string name, Assembly assembly, DllImportSearchPath? searchPath) => name switch
        {
            "audioplugin_haptoflow" => Load(PluginFile()),
            "onnxruntime" => Load(RepositoryFiles.OnnxRuntime),
            _ => IntPtr.Zero,
        };

        private static string PluginFile()
        {
            string file = OperatingSystem.IsWindows() ? "audioplugin_haptoflow.dll"
                : OperatingSystem.IsMacOS() ? "libaudioplugin_haptoflow.dylib" : "libaudioplugin_haptoflow.so";
            return Path.Combine(RepositoryFiles.NativeFolder, file);
        }

        private static IntPtr Load(string path) => File.Exists(path)
            ? NativeLibrary.Load(path)
            : throw new FileNotFoundException(
                $"{path} is missing: run `npm ci` and `npm run build`, or set HAPTOFLOW_NATIVE_DIR to a native " +
                    $"build", path);
    }
}
