#nullable enable
using UnityEngine;
using UnityEngine.XR.Management;

namespace HaptoFlow.Project
{
    /// <summary>Starts the headset together with the scene, on Windows. In this project's settings Windows leaves that
    /// to scenes, so that a scene for the desk starts no headset's software; on Android the headset is on from the
    /// start.</summary>
    [DisallowMultipleComponent]
    public sealed class StartHeadset : MonoBehaviour
    {
        private XRManagerSettings? started;

        // XR Plug-in Management is not ready before Start.
        private void Start()
        {
            XRGeneralSettings? settings = XRGeneralSettings.Instance;
            XRManagerSettings? manager = settings != null ? settings.Manager : null;
            // Only on Windows does Unity's OpenXR find headsets of a computer.
            bool isWindows = Application.platform == RuntimePlatform.WindowsEditor ||
                Application.platform == RuntimePlatform.WindowsPlayer;
            if (!isWindows || manager == null || manager.activeLoader != null)
            {
                return;
            }
            manager.InitializeLoaderSync();
            if (manager.activeLoader == null)
            {
                Debug.Log("HaptoFlow: no headset answered, so the scene plays with mouse and graphics pen. Start the " +
                    "headset's software (Meta Quest Link, SteamVR), then press Play again.", this);
                return;
            }
            manager.StartSubsystems();
            started = manager;
        }

        private void OnDestroy()
        {
            if (started != null)
            {
                started.DeinitializeLoader();
            }
        }
    }
}
