using System;
using System.Collections.Generic;
using HaptoFlow.Samples.LatencyStudy;
using HaptoFlow.Studies;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>A simulated participant: follows the marker a few frames late with the pen in the right hand, and
    /// answers with the left hand, yes from a certain delay on.</summary>
    internal sealed class LatencyParticipant
    {
        private const string PenHand = "<XRController>{RightHand}/";
        private const string AnswerHand = "<XRController>{LeftHand}/";
        private const int LagFrames = 6;
        private const float PressedHeight = 0.001f;

        private readonly LatencyStudy study;
        private readonly Queue<Vector3> seen = new Queue<Vector3>();
        private Vector3 place;
        private bool trembles;

        public LatencyParticipant(LatencyStudy study)
        {
            this.study = study;
            place = study.Marker.transform.position;
            place.y = PressedHeight;
        }

        /// <summary>The smallest delay that the participant notices, in ms.</summary>
        public double ThresholdMilliseconds { get; set; } = 130.0;

        /// <summary>Whether the pen follows the marker; false for a pen that rests at the start.</summary>
        public bool Follows { get; set; } = true;

        /// <summary>Simulates one frame.</summary>
        public void Frame()
        {
            seen.Enqueue(study.Marker.transform.position);
            if (seen.Count > LagFrames)
            {
                seen.Dequeue();
            }
            if (Follows)
            {
                place = seen.Peek();
                place.y = PressedHeight;
            }
            SimulatedInput.SetControl(PenHand + "isTracked", 1f);
            // A small jitter, because a real tracker never reports the same pose twice.
            trembles = !trembles;
            SimulatedInput.SetControl(PenHand + "pointerPosition", place + (trembles ? 1e-6f : 0f) * Vector3.right);
            SimulatedInput.SetControl(PenHand + "pointerRotation", Quaternion.identity);
            Answer();
            World.Frame();
        }

        /// <summary>Takes part until a condition holds.</summary>
        public void Until(Func<bool> isSo, double patienceSeconds = 60.0)
        {
            double end = Clock.UnscaledSeconds + patienceSeconds;
            while (!isSo())
            {
                if (Clock.UnscaledSeconds > end)
                {
                    throw new TimeoutException($"nothing came of it in {patienceSeconds} s; the panel says: " +
                        $"{study.Panel.Text}; the operator reads: {string.Join(" | ", study.View.Lines)}");
                }
                Frame();
            }
        }

        private void Answer()
        {
            bool isAsked = study.Session?.Phase == StudyPhase.Question;
            bool isYes = isAsked && study.Session!.Trial!.DelayMilliseconds >= ThresholdMilliseconds;
            SimulatedInput.SetControl(AnswerHand + "triggerPressed", isAsked && isYes ? 1f : 0f);
            SimulatedInput.SetControl(AnswerHand + "gripPressed", isAsked && !isYes ? 1f : 0f);
        }
    }
}
