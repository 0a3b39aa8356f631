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
            string address = HelpPages.AddressOf(HelpPages.Index);
            if (address.Length == 0)
            {
                Debug.LogWarning("HaptoFlow: the package's folder Documentation~ is missing. Install the package again " +
                    "from its tarball.");
                return;
            }
            Application.OpenURL(address);
        }
    }
}
