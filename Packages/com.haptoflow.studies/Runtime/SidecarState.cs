#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Studies
{
    /// <summary>The progress of a session, as its sidecar records it.</summary>
    /// <param name="Session">8 hexadecimal digits.</param>
    /// <param name="Created">UTC, to the second.</param>
    internal sealed record SidecarState(string Session, string Created)
    {
        public const string Format = "haptoflow-study";
        public const int Version = 1;

        public bool IsFinished { get; set; }

        /// <summary>The trials at which the session was resumed.</summary>
        public List<int> ResumedAtTrials { get; } = new List<int>();

        /// <exception cref="FormatException">The document is not a sidecar; the message names the key.</exception>
        public static SidecarState Read(JsonValue document)
        {
            if (document["format"].AsText() != Format || document["version"].AsInteger() != Version)
            {
                throw new FormatException($"this is not a \"{Format}\" of version {Version}");
            }
            var state = new SidecarState(document["session"].AsText(), document["created"].AsText())
            {
                IsFinished = document["finished"].AsBoolean(),
            };
            state.ResumedAtTrials.AddRange(document["resumed_at_trials"].AsArray().Select(each => each.AsInteger()));
            return state;
        }
    }
}
