#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.SampleScenes
{
    /// <summary>Slides a kinematic body to and fro in physics steps, as games move their platforms. A stylus that is
    /// held still on it feels its texture pass.</summary>
    internal sealed class SlidingMotion : MonoBehaviour
    {
        private Rigidbody body = null!;
        private Vector3 centre;
        private double startSeconds;

        /// <summary>The largest displacement from the centre, in metres along the axes of the parent.</summary>
        public Vector3 Reach { get; set; } = new Vector3(0.04f, 0f, 0f);

        public float PeriodSeconds { get; set; } = 2f;

        private void Awake()
        {
            body = GetComponent<Rigidbody>();
            body.isKinematic = true;
            // Interpolation moves the body in every frame, so that the felt motion matches the visible one.
            body.interpolation = RigidbodyInterpolation.Interpolate;
            centre = transform.localPosition;
            startSeconds = Time.fixedTimeAsDouble;
        }

        private void FixedUpdate()
        {
            double swings = (Time.fixedTimeAsDouble - startSeconds) / PeriodSeconds;
            Vector3 place = centre + (float)Math.Sin(2.0 * Math.PI * swings) * Reach;
            Transform? parent = transform.parent;
            body.MovePosition(parent != null ? parent.TransformPoint(place) : place);
        }
    }
}
