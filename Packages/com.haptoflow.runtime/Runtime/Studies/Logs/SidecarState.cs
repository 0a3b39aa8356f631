#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Studies
{
    /// <summary>The progress of a session, as its sidecar records it.</summary>
    internal sealed class SidecarState
    {
        public const string Format = "haptoflow-study";
        public const int Version = 1;

        public SidecarState(string session, string created)
        {
            Session = session;
            Created = created;
        }

        /// <summary>8 hexadecimal digits.</summary>
        public string Session { get; }

        /// <summary>UTC, to the second.</summary>
        public string Created { get; }

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
