#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.Samples.StylusTracing
{
    /// <summary>Slides a kinematic body to and fro, at physics steps as games move their platforms. A stylus held still
    /// on it feels it pass.</summary>
    public sealed class SlidingMotion : MonoBehaviour
    {
        private Rigidbody body = null!;
        private Vector3 centre;
        private double beganSeconds;

        /// <summary>How far it goes from its centre, in metres along its parent's axes.</summary>
        public Vector3 Reach { get; set; } = new Vector3(0.04f, 0f, 0f);

        /// <summary>Seconds for a whole swing.</summary>
        public float PeriodSeconds { get; set; } = 2f;

        private void Awake()
        {
            body = GetComponent<Rigidbody>();
            body.isKinematic = true;
            // Drawn at every frame where it is then: what is felt moves as what is seen.
            body.interpolation = RigidbodyInterpolation.Interpolate;
            centre = transform.localPosition;
            beganSeconds = Time.fixedTimeAsDouble;
        }

        private void FixedUpdate()
        {
            double swings = (Time.fixedTimeAsDouble - beganSeconds) / PeriodSeconds;
            Vector3 place = centre + (float)Math.Sin(2.0 * Math.PI * swings) * Reach;
            Transform? parent = transform.parent;
            body.MovePosition(parent != null ? parent.TransformPoint(place) : place);
        }
    }
}
