#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Tip force from an action of Meta's SDK: for MX Ink, the action that its action set binds to
    /// tip_logitech/force.</summary>
    [AddComponentMenu("HaptoFlow/Tip Force (Meta)")]
    [HelpURL(HelpPages.Components + "tip-force-meta")]
    public sealed class MetaActionTipForce : PressureTipForce
    {
        [SerializeField, Tooltip("Name of the float action in the project's action sets.")]
        private string action = "tip";

        /// <inheritdoc/>
        protected override bool TryReadPressure(out float pressure) =>
            OVRPlugin.GetActionStateFloat(action, out pressure);
    }
}
