#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Opens the documentation's first page: Window > HaptoFlow > Documentation.</summary>
    internal static class DocumentationMenu
    {
        [MenuItem("Window/HaptoFlow/Documentation", false, 2110)]
        internal static void Open()
        {
            string address = HelpPages.AddressOfPage(HelpPages.Index);
            if (address.Length == 0)
            {
                Debug.LogWarning("HaptoFlow: this package came without its pages, as it does from a git URL. They are in " +
                    "the tarball of a release, and in the folder Documentation~ of a clone.");
                return;
            }
            Application.OpenURL(address);
        }
    }
}
