using System;
using System.Collections.Generic;
using HaptoFlow.Studies;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>Compares what a pen does with what reaches a channel of the audio device: both in frames of the device
    /// since <see cref="Begin"/>.</summary>
    internal sealed class ToneWatch
    {
        // Longer than a half wave of 200 Hz.
        private const int LongestGapFrames = 240;

        private readonly int channel;
        private bool wasMoving;

        public ToneWatch(HapticStylus stylus, int channel)
        {
            this.channel = channel;
            stylus.TouchBegan += OnMoved;
            stylus.TouchMoved += OnMoved;
            stylus.TouchEnded += (HapticStylus told, in HapticContact contact) => Note(false);
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

        private void OnMoved(HapticStylus told, in HapticContact contact) =>
            Note(contact.TangentialVelocity.magnitude >= TrialContact.MovingMps);

        private void Note(bool moves)
        {
            if (moves != wasMoving)
            {
                (moves ? Starts : Stops).Add(AudioDevice.RecordedFrames);
            }
            wasMoving = moves;
        }
    }
}
