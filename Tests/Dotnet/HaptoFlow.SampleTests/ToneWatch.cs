using System.Collections.Generic;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>Compares what a pen does with what reaches a channel of the audio device: both in frames of the device
    /// since <see cref="Begin"/>.</summary>
    internal sealed class ToneWatch
    {
        // Longer than a half wave of 200 Hz.
        private const int LongestGapFrames = 240;
        private const float TrembleMetres = 1e-5f;

        private readonly int channel;
        private Vector3 place;
        private bool wasMoving;

        public ToneWatch(HapticStylus stylus, int channel)
        {
            this.channel = channel;
            stylus.TouchMoved += OnMoved;
        }

        /// <summary>When the pen set off: the next block hears of it first.</summary>
        public List<int> Starts { get; } = new List<int>();

        /// <summary>When the pen stopped.</summary>
        public List<int> Stops { get; } = new List<int>();

        public void Begin()
        {
            AudioDevice.Forget();
            Starts.Clear();
            Stops.Clear();
        }

        /// <summary>Where the channel sounded, first and last frame.</summary>
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

        /// <summary>By the pen's places alone: the frame in which it is elsewhere than in the last is the first of a
        /// motion.</summary>
        private void OnMoved(HapticStylus told, in HapticContact contact)
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
