#nullable enable
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Tip force from an action of Meta's SDK: for MX Ink, the action that its action set binds to
    /// tip_logitech/force.</summary>
    /// <remarks>An <see cref="XrPen"/> reads this force by itself; use this component on a stylus that follows the pen in
    /// another way. The SDK logs an error for every failing call, so it is called only while the session has input focus.
    /// After a failure it is called again when something changed (the focus returns, a controller connects or
    /// disconnects, the action gets another name, this component is enabled again), else less and less often.</remarks>
    [AddComponentMenu("HaptoFlow/Tip Force (Meta)")]
    [HelpPage(HelpPages.Components + "tip-force-meta")]
    public sealed class MetaActionTipForce : PressureTipForce
    {
        [SerializeField, Tooltip("The name of the float action in the project's action sets.")]
        private string action = "tip";

        private readonly MetaHand left = new MetaHand(HapticHand.Left);
        private readonly MetaHand right = new MetaHand(HapticHand.Right);
        private readonly RetryDelay retry = new RetryDelay(2.0, 64.0);
        private int version = -1;
        private bool hasWarned;

        // A pen that sleeps stays in its hand: what was felt there must not move to a loudspeaker.
        private HapticHand lastHand;

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
        public override HapticHand HeldIn
        {
            get
            {
                left.Refresh();
                right.Refresh();
                lastHand = right.HoldsMxInk ? HapticHand.Right : left.HoldsMxInk ? HapticHand.Left : lastHand;
                return lastHand;
            }
        }

        /// <inheritdoc/>
        protected override bool TryReadPressure(out float pressure)
        {
            pressure = 0f;
            left.Refresh();
            right.Refresh();
            if (left.Version + right.Version != version)
            {
                version = left.Version + right.Version;
                retry.Forget();
            }
            double now = Time.realtimeSinceStartupAsDouble;
            if (!right.HasFocus || !retry.IsDue(now))
            {
                return false;
            }
            if (!OVRPlugin.GetActionStateFloat(action, out pressure))
            {
                retry.Fail(now);
                Warn();
                return false;
            }
            retry.Forget();
            return true;
        }

        private void OnEnable() => Retry();

        private void OnValidate() => Retry();

        private void Retry()
        {
            retry.Forget();
            hasWarned = false;
        }

        private void Warn()
        {
            if (!hasWarned)
            {
                hasWarned = true;
                Debug.LogWarning($"HaptoFlow: {name} reads no tip force: Meta's SDK has no float action \"{action}\" " +
                    "that is bound to a connected pen. For an MX Ink, use the action set of Logitech's integration " +
                    "package (logitech.github.io/mxink) under Project Settings > Meta XR > Input Actions. HaptoFlow " +
                    "tries again, less and less often.", this);
            }
        }
    }
}
