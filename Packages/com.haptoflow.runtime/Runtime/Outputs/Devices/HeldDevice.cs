#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The device that a wave plays on: of the sinks to try, the first whose device is there, and its queue.
    /// Main thread.</summary>
    internal sealed class HeldDevice
    {
        private readonly List<(HapticForm Form, IHapticSink Sink)> sinks = new List<(HapticForm, IHapticSink)>();

        /// <summary>Null until a device was found.</summary>
        public IHapticSink? Sink { get; private set; }

        public HapticForm Form { get; private set; }

        /// <summary>Null until a device was found.</summary>
        public HapticQueue? Queue { get; private set; }

        public bool IsThere => Sink != null && Sink.TryGetCapabilities(out _);

        public bool HasSinks => sinks.Count > 0;

        /// <summary>Adds a sink to try after all others.</summary>
        public void Add(HapticForm form, IHapticSink sink) => sinks.Add((form, sink));

        /// <summary>Uses the first sink whose device is there.</summary>
        /// <returns>True where it is another one than before.</returns>
        public bool Find(IWaveSource source, bool mayReplace = true)
        {
            (HapticForm form, IHapticSink sink) = sinks.Find(each => each.Sink.TryGetCapabilities(out _));
            if (sink == null || ReferenceEquals(sink, Sink))
            {
                return false;
            }
            Flush();
            Queue?.Dispose();
            (Form, Sink, Queue) = (form, sink, HapticQueue.For(form, sink, source, mayReplace));
            return true;
        }

        /// <summary>Discards what was submitted.</summary>
        public void Flush() => Queue?.Flush(Time.realtimeSinceStartupAsDouble);

        /// <summary>Stops the device and forgets all sinks.</summary>
        public void Close()
        {
            Flush();
            Queue?.Dispose();
            (Queue, Sink) = (null, null);
            sinks.ForEach(each => (each.Sink as IDisposable)?.Dispose());
            sinks.Clear();
        }
    }
}
