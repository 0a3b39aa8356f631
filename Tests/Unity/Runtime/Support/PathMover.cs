#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.Tests
{
    /// <summary>Moves an object along a path, given as a function of the seconds since its first frame.</summary>
    internal sealed class PathMover : MonoBehaviour
    {
        private double beganSeconds = double.NaN;

        public Func<double, Vector3>? Path { get; set; }

        public double Seconds => double.IsNaN(beganSeconds) ? 0.0 : Time.unscaledTimeAsDouble - beganSeconds;

        private void Update()
        {
            if (double.IsNaN(beganSeconds))
            {
                beganSeconds = Time.unscaledTimeAsDouble;
            }
            if (Path != null)
            {
                transform.position = Path(Seconds);
            }
        }
    }

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

    /// <summary>Counts a stylus's events and keeps the last contacts.</summary>
    internal sealed class TouchLog
    {
        public TouchLog(HapticStylus stylus)
        {
            stylus.TouchBegan += (HapticStylus _, in HapticContact contact) =>
            {
                ++Began;
                Last = contact;
            };
            stylus.TouchMoved += (HapticStylus _, in HapticContact contact) =>
            {
                ++Moved;
                Last = contact;
            };
            stylus.TouchEnded += (HapticStylus _, in HapticContact contact) => ++Ended;
        }

        public int Began { get; private set; }

        public int Moved { get; private set; }

        public int Ended { get; private set; }

        public HapticContact Last { get; private set; }
    }

    /// <summary>A force that a test sets.</summary>
    internal sealed class FixedForce : TipForceSource
    {
        public float ForceNewtons { get; set; }

        public bool HasNews { get; set; } = true;

        public override bool TryRead(out float forceNewtons)
        {
            forceNewtons = ForceNewtons;
            return HasNews;
        }
    }
}
