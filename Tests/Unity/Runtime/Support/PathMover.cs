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
}
