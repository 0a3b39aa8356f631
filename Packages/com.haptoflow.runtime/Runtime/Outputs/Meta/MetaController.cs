#nullable enable
using HaptoFlow.Outputs;
using UnityEngine;
using UnityEngine.Scripting;

// No scene references this assembly, which registers device routes when it is loaded.
[assembly: AlwaysLinkAssembly]

namespace HaptoFlow
{
    /// <summary>The device in one hand as a route of Meta's SDK sees it. No call is made while the session has no input
    /// focus or the hand is empty. After a failure the next call waits, longer each time, unless the session or the
    /// controllers change; each failure is logged once until then.</summary>
    internal sealed class MetaController
    {
        private readonly MetaHand hand;
        private readonly RetryDelay retry;
        private int version = -1;

        /// <param name="hand">The hand.</param>
        /// <param name="firstRetrySeconds">Delay after a failure, doubled with each further one. Calls of which the SDK
        /// logs each failure need a long one.</param>
        public MetaController(HapticHand hand, double firstRetrySeconds)
        {
            this.hand = new MetaHand(hand);
            retry = new RetryDelay(firstRetrySeconds, 32.0 * firstRetrySeconds);
            Name = hand.InWords();
        }

        public OVRInput.Controller Mask => (OVRInput.Controller)hand.Mask;

        public OVRPlugin.Hand Hand => hand.Hand;

        /// <summary>Left or right, for messages.</summary>
        public string Name { get; }

        /// <summary>Increases whenever cached capabilities may be out of date.</summary>
        public int Version => hand.Version;

        /// <summary>True while a Touch controller is in the hand and a call may be made.</summary>
        public bool HoldsTouch => IsUsable() && hand.IsConnected && !hand.HoldsMxInk && !hand.HoldsDisguisedMxInk;

        /// <summary>True while an MX Ink with its action set is in the hand and a call may be made.</summary>
        public bool HoldsMxInk => IsUsable() && hand.HoldsMxInk;

        /// <summary>Call it after a failed call.</summary>
        /// <returns>True where it should be logged.</returns>
        public bool Fail() => retry.Fail(Time.realtimeSinceStartupAsDouble);

        /// <summary>Call it after a successful call.</summary>
        public void Succeed() => retry.Forget();

        private bool IsUsable()
        {
            hand.Refresh();
            if (hand.Version != version)
            {
                version = hand.Version;
                retry.Restart();
            }
            return hand.HasFocus && retry.IsDue(Time.realtimeSinceStartupAsDouble);
        }
    }
}
