#nullable enable
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>An MX Ink through Meta's SDK, with the names of Logitech's action set: pose by "aim_right" and
    /// "aim_left", force by "tip". An <see cref="XrPen"/> uses it by itself.</summary>
    internal sealed class MetaPen : IPenDevice
    {
        private const string Force = "tip";

        private readonly MetaHand hand;
        private readonly string pose;
        // The SDK logs an error for every failing call.
        private readonly RetryDelay poseRetry = new RetryDelay(2.0, 64.0);
        private readonly RetryDelay forceRetry = new RetryDelay(2.0, 64.0);
        private int version = -1;
        private bool hasWarned;

        public MetaPen(PenHand hand)
        {
            this.hand = new MetaHand(hand == PenHand.Left ? HapticHand.Left : HapticHand.Right);
            pose = hand == PenHand.Left ? "aim_left" : "aim_right";
        }

        public bool TryRead(out Vector3 position, out Quaternion rotation, out float pressure)
        {
            position = default;
            rotation = Quaternion.identity;
            pressure = float.NaN;
            hand.Refresh();
            if (hand.Version != version)
            {
                version = hand.Version;
                poseRetry.Forget();
                forceRetry.Forget();
                hasWarned = false;
            }
            double now = Time.realtimeSinceStartupAsDouble;
            if (!hand.HasFocus || !hand.HoldsMxInk || !poseRetry.IsDue(now))
            {
                return false;
            }
            if (!OVRPlugin.GetActionStatePose(pose, out OVRPlugin.Posef read))
            {
                poseRetry.Fail(now);
                Warn(pose);
                return false;
            }
            poseRetry.Forget();
            // From a right-handed frame, in which z points backwards.
            position = new Vector3(read.Position.x, read.Position.y, -read.Position.z);
            rotation = new Quaternion(
                -read.Orientation.x, -read.Orientation.y, read.Orientation.z, read.Orientation.w);
            pressure = ReadForce(now);
            return true;
        }

        private float ReadForce(double now)
        {
            if (!forceRetry.IsDue(now))
            {
                return float.NaN;
            }
            if (!OVRPlugin.GetActionStateFloat(Force, out float force))
            {
                forceRetry.Fail(now);
                Warn(Force);
                return float.NaN;
            }
            forceRetry.Forget();
            return force;
        }

        private void Warn(string action)
        {
            if (!hasWarned)
            {
                hasWarned = true;
                Debug.LogWarning($"HaptoFlow: an MX Ink is in the hand, but Meta's SDK has no action \"{action}\" that is " +
                    "bound to it. Use the action set of Logitech's integration package (logitech.github.io/mxink) " +
                    "under Project Settings > Meta XR > Input Actions. HaptoFlow tries again, less and less often.");
            }
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Register() => PenDevices.Register("Meta MX Ink", hand => new MetaPen(hand));
    }
}
