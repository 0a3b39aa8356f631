using System.Collections.Generic;

namespace UnityEngine.XR.Management
{
    /// <summary>Part of Unity's XR Plug-in Management: the settings of the platform that plays.</summary>
    public class XRGeneralSettings : ScriptableObject
    {
        public static XRGeneralSettings? Instance { get; set; }

        public XRManagerSettings? Manager { get; set; }
    }

    public sealed class XRManagerSettings : ScriptableObject
    {
        /// <summary>What was called, in order.</summary>
        internal List<string> Calls { get; } = new List<string>();

        /// <summary>The loader that finds a headset; null where none is connected.</summary>
        internal XRLoader? Working { get; set; }

        public XRLoader? activeLoader { get; internal set; }

        public void InitializeLoaderSync()
        {
            Calls.Add("initialize");
            activeLoader = Working;
        }

        public void StartSubsystems() => Calls.Add("start");

        public void StopSubsystems() => Calls.Add("stop");

        public void DeinitializeLoader()
        {
            StopSubsystems();
            Calls.Add("deinitialize");
            activeLoader = null;
        }
    }

    public abstract class XRLoader : ScriptableObject
    {
    }
}
