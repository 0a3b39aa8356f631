#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The project's audio settings, which Unity gives scripts no property for.</summary>
    internal static class ProjectAudio
    {
        private const string SettingsPath = "ProjectSettings/AudioManager.asset";

        /// <summary>Whether Project Settings > Audio > Disable Unity Audio is on.</summary>
        public static bool IsDisabled()
        {
            foreach (Object settings in AssetDatabase.LoadAllAssetsAtPath(SettingsPath))
            {
                using var serialized = new SerializedObject(settings);
                SerializedProperty? disabled = serialized.FindProperty("m_DisableAudio");
                if (disabled != null)
                {
                    return disabled.boolValue;
                }
            }
            return false;
        }
    }
}
