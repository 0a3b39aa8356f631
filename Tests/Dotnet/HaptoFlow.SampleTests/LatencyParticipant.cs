using System;
using System.Collections.Generic;
using HaptoFlow.Samples.LatencyStudy;
using HaptoFlow.Studies;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>Follows the marker some frames behind with the pen in the right hand, and answers with the left one:
    /// yes from a delay on.</summary>
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

        /// <summary>Delays from here on are noticed, in ms.</summary>
        public double ThresholdMilliseconds { get; set; } = 130.0;

        /// <summary>False for a pen that rests at the beginning.</summary>
        public bool Follows { get; set; } = true;

        /// <summary>A frame of taking part.</summary>
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
            // A real tracker never repeats itself.
            trembles = !trembles;
            SimulatedInput.SetControl(PenHand + "pointerPosition", place + (trembles ? 1e-6f : 0f) * Vector3.right);
            SimulatedInput.SetControl(PenHand + "pointerRotation", Quaternion.identity);
            Answer();
            World.Frame();
        }

        /// <summary>Takes part until something is so.</summary>
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
