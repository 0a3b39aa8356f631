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
            // A small jitter, because a real tracker never reports the same pose twice.
            trembles = !trembles;
            SampleTest.Track(place + (trembles ? 1e-6f : 0f) * Vector3.right, "pointerPosition");
            Answer();
            World.Frame();
        }

        public void Until(Func<bool> isSo, double patienceSeconds = 60.0)
        {
            double end = Clock.UnscaledSeconds + patienceSeconds;
            while (!isSo())
            {
                if (Clock.UnscaledSeconds > end)
                {
                    throw new TimeoutException($"nothing came of it in {patienceSeconds} s; the panel says: " +
                        $"{study.Panel.text}; the operator reads: {string.Join(" | ", study.View.Lines)}");
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

    /// <summary>Compares the motion of a pen with the output on a channel of the audio device. Both are counted in
    /// frames of the device since <see cref="Begin"/>.</summary>
    internal sealed class ToneRecorder
    {
        // Longer than half a period of 200 Hz.
        private const int LongestGapFrames = 240;
        private const float TrembleMetres = 1e-5f;

        private readonly int channel;
        private Vector3 place;
        private bool wasMoving;

        public ToneRecorder(HapticStylus stylus, int channel)
        {
            this.channel = channel;
            stylus.TouchMoved += OnMoved;
        }

        /// <summary>The frame in which the pen set off. The next audio block is the first that can react.</summary>
        public List<int> Starts { get; } = new List<int>();

        public List<int> Stops { get; } = new List<int>();

        public void Begin()
        {
            AudioDevice.Forget();
            Starts.Clear();
            Stops.Clear();
        }

        /// <summary>The first and last frame of each audible stretch on the channel.</summary>
        public List<(int First, int Last)> Tones()
        {
            var tones = new List<(int First, int Last)>();
            for (int frame = 0; frame < AudioDevice.RecordedFrames; ++frame)
            {
                if (AudioDevice.Sample(frame, channel) == 0f)
                {
                    continue;
                }
                if (tones.Count > 0 && frame - tones[tones.Count - 1].Last <= LongestGapFrames)
                {
                    tones[tones.Count - 1] = (tones[tones.Count - 1].First, frame);
                }
                else
                {
                    tones.Add((frame, frame));
                }
            }
            return tones;
        }

        /// <summary>Detects motion from the positions of the pen: it begins in the first frame with a changed position.
        /// </summary>
        private void OnMoved(HapticStylus stylus, in HapticContact contact)
        {
            bool moves = Vector3.Distance(contact.Point, place) > TrembleMetres;
            if (moves != wasMoving)
            {
                (moves ? Starts : Stops).Add(AudioDevice.RecordedFrames);
            }
            wasMoving = moves;
            place = contact.Point;
        }
    }
}
