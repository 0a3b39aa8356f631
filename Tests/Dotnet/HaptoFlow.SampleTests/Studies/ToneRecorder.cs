using System.Collections.Generic;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
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

        /// <summary>The frame in which the pen stopped.</summary>
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
