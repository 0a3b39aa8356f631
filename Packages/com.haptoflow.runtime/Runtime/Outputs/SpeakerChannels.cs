#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Counts the channels of an audio device. Unity has no such count.</summary>
    internal static class SpeakerChannels
    {
        /// <summary>The number of channels of a speaker mode.</summary>
        public static int Count(AudioSpeakerMode mode) => mode switch
        {
            AudioSpeakerMode.Mono => 1,
            AudioSpeakerMode.Quad => 4,
            AudioSpeakerMode.Surround => 5,
            AudioSpeakerMode.Mode5point1 => 6,
            AudioSpeakerMode.Mode7point1 => 8,
            _ => 2,
        };
    }
}
