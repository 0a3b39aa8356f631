#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.Tests
{
    /// <summary>Moves a kinematic body at physics steps, as games move platforms.</summary>
    internal sealed class PlatformMover : MonoBehaviour
    {
        private Rigidbody body = null!;
        private double beganSeconds;

        public Func<double, Vector3>? Path { get; set; }

        public static PlatformMover On(GameObject owner, RigidbodyInterpolation interpolation, Func<double, Vector3> path)
        {
            var body = owner.AddComponent<Rigidbody>();
            body.isKinematic = true;
            body.interpolation = interpolation;
            var mover = owner.AddComponent<PlatformMover>();
            mover.body = body;
            mover.beganSeconds = Time.fixedTimeAsDouble;
            mover.Path = path;
            return mover;
        }

        private void FixedUpdate() => body.MovePosition(Path!(Time.fixedTimeAsDouble - beganSeconds));
    }
}
