using System;
using UnityShim;

namespace UnityEngine
{
    public class Application
    {
        public static bool isPlaying => World.IsPlaying;

        public static string persistentDataPath => ProjectFolders.Persistent;

        public static string productName => "Shim";

        public static string version => "0.1";

        public static string unityVersion => "2022.3.76f1";

        public static RuntimePlatform platform => World.Platform;

        public static void OpenURL(string url) => World.OpenedUrl = url;

        public static event Action? quitting
        {
            add => World.Quitting += value;
            remove => World.Quitting -= value;
        }

        public delegate void LogCallback(string condition, string stackTrace, LogType type);

        public static event LogCallback? logMessageReceived
        {
            add => UnityShim.Log.Received += value;
            remove => UnityShim.Log.Received -= value;
        }
    }

    public enum RuntimePlatform
    {
        OSXEditor = 0,
        WindowsPlayer = 2,
        WindowsEditor = 7,
        Android = 11,
        LinuxEditor = 16,
    }

    public class Debug
    {
        public static void Log(object message) => UnityShim.Log.Write(LogType.Log, message);
        public static void Log(object message, Object? context) => UnityShim.Log.Write(LogType.Log, message);
        public static void LogWarning(object message) => UnityShim.Log.Write(LogType.Warning, message);
        public static void LogWarning(object message, Object? context) => UnityShim.Log.Write(LogType.Warning, message);
        public static void LogError(object message) => UnityShim.Log.Write(LogType.Error, message);
        public static void LogError(object message, Object? context) => UnityShim.Log.Write(LogType.Error, message);
        public static void LogException(Exception exception) => UnityShim.Log.Write(LogType.Exception, exception);
        public static void LogException(Exception exception, Object? context) => UnityShim.Log.Write(LogType.Exception, exception);
    }

    public sealed partial class Resources
    {
        public static T Load<T>(string path)
            where T : Object => World.Resource(path) is T asset ? asset : null!;
    }
}

namespace Unity.Profiling
{
    public struct ProfilerMarker
    {
        public ProfilerMarker(string name)
        {
        }

        public AutoScope Auto() => default;

        public struct AutoScope : IDisposable
        {
            public void Dispose()
            {
            }
        }
    }
}

namespace UnityEngine
{
    public sealed class SystemInfo
    {
        public static string deviceModel => "a stand-in";

        public static string operatingSystem => "the stand-in's system";

        public static string processorType => "a processor";
    }
}
