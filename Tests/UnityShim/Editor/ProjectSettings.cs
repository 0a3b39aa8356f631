using System;
using System.Collections.Generic;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public enum SettingsScope
    {
        User = 0,
        Project = 1,
    }

    [AttributeUsage(AttributeTargets.Method)]
    public sealed partial class SettingsProviderAttribute : Attribute
    {
    }

    public partial class SettingsProvider
    {
        private string? title;

        public SettingsProvider(string path, SettingsScope scopes, IEnumerable<string>? keywords = null)
        {
            settingsPath = path;
            scope = scopes;
            this.keywords = keywords ?? Array.Empty<string>();
        }

        public string settingsPath { get; }

        public SettingsScope scope { get; }

        public IEnumerable<string> keywords { get; set; }

        public string label
        {
            get => title ?? settingsPath.Substring(settingsPath.LastIndexOf('/') + 1);
            set => title = value;
        }

        public Action<string>? guiHandler { get; set; }

        public Action? inspectorUpdateHandler { get; set; }

        public virtual void OnGUI(string searchContext) => guiHandler?.Invoke(searchContext);
    }

    public static partial class SettingsService
    {
        public static EditorWindow? OpenProjectSettings(string? settingsPath = null)
        {
            EditorSession.OpenedSettings = settingsPath;
            return null;
        }
    }

    public sealed partial class PlayerSettings : Object
    {
        private static Object[] preloaded = Array.Empty<Object>();

        public static Object[] GetPreloadedAssets() => (Object[])preloaded.Clone();

        public static void SetPreloadedAssets(Object[] assets) => preloaded = (Object[])assets.Clone();
    }
}

namespace UnityShim
{
    /// <summary>The project's audio settings, which scripts read as an asset.</summary>
    internal sealed class AudioManager : Object
    {
        public const string Path = "ProjectSettings/AudioManager.asset";

        public static readonly AudioManager OfProject = new AudioManager();

        [SerializeField]
        private bool m_DisableAudio;

        public static bool DisablesAudio { set => OfProject.m_DisableAudio = value; }
    }
}
