#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Tip force from an action of Meta's SDK: for MX Ink, the action that its action set binds to
    /// tip_logitech/force.</summary>
    /// <remarks>The SDK logs an error for every failing call, so it is called only while the session has input focus,
    /// and after a failure only when something changed: the focus returns, a controller connects or disconnects, the
    /// action gets another name, or this component is enabled again.</remarks>
    [AddComponentMenu("HaptoFlow/Tip Force (Meta)")]
    [HelpPage(HelpPages.Components + "tip-force-meta")]
    public sealed class MetaActionTipForce : PressureTipForce
    {
        [SerializeField, Tooltip("The name of the float action in the project's action sets.")]
        private string action = "tip";

        private OVRPlugin.Controller connectedAtFailure;
        private bool hadFocus;
        private bool hasFailed;
        private bool hasWarned;

        /// <summary>Name of the float action in the project's action sets.</summary>
        public string Action
        {
            get => action;
            set
            {
                action = value;
                Retry();
            }
        }

        /// <inheritdoc/>
        protected override bool TryReadPressure(out float pressure)
        {
            pressure = 0f;
            bool hasFocus = OVRPlugin.hasInputFocus;
            bool gainedFocus = hasFocus && !hadFocus;
            hadFocus = hasFocus;
            if (!hasFocus || (hasFailed && !gainedFocus && OVRPlugin.GetConnectedControllers() == connectedAtFailure))
            {
                return false;
            }
            hasFailed = !OVRPlugin.GetActionStateFloat(action, out pressure);
            if (hasFailed)
            {
                connectedAtFailure = OVRPlugin.GetConnectedControllers();
                Warn();
            }
            return !hasFailed;
        }

        private void OnEnable() => Retry();

        private void OnValidate() => Retry();

        private void Retry()
        {
            hasFailed = false;
            hasWarned = false;
        }

        private void Warn()
        {
            if (!hasWarned)
            {
                hasWarned = true;
                Debug.LogWarning($"HaptoFlow: {name} reads no tip force: Meta's SDK has no float action \"{action}\" " +
                    "that is bound to a connected pen (Project Settings > Meta XR > Input Actions). HaptoFlow " +
                    "tries again when the session or the controllers change.", this);
            }
        }
    }
}
