#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Creates the sink of one route to the device in a hand.</summary>
    /// <param name="hand">The hand; never <see cref="HapticHand.None"/>.</param>
    public delegate IHapticSink HapticSinkMaker(HapticHand hand);

    /// <summary>The routes to devices that are available: Unity's own, and those that optional packages register when
    /// they are loaded. Main thread.</summary>
    public static class HapticSinks
    {
        private static readonly List<Route> Routes = new List<Route>();

        /// <summary>Adds a route, or replaces the one of the same name. Call it from a method that Unity runs when the
        /// assembly is loaded; outputs that are already open do not use the new route.</summary>
        /// <param name="preference">Among routes of the same form the higher one is taken. Unity's own routes have
        /// 0.</param>
        public static void Register(string name, HapticForm form, int preference, HapticSinkMaker maker)
        {
            Routes.RemoveAll(route => route.Name == name);
            int place = Routes.FindIndex(route => route.Preference < preference);
            Routes.Insert(place < 0 ? Routes.Count : place, new Route(name, form, preference, maker));
        }

        /// <summary>Opens a sink for each route of a form, in order of preference.</summary>
        internal static void Open(HapticForm form, HapticHand hand, HeldDevice into)
        {
            foreach (Route route in Routes)
            {
                if (route.Form == form)
                {
                    into.Add(form, route.Maker(hand));
                }
            }
        }

        /// <summary>Opens a sink for each route that plays the waveform, or else its envelope, best first.</summary>
        internal static void OpenBest(HapticHand hand, HeldDevice into)
        {
            Open(HapticForm.Waveform, hand, into);
            Open(HapticForm.Amplitude, hand, into);
        }

        internal static IReadOnlyList<string> Names() => Routes.ConvertAll(route => route.Name);

        internal static void ForEach(Action<string, HapticForm, HapticSinkMaker> act) =>
            Routes.ForEach(route => act(route.Name, route.Form, route.Maker));

        private sealed record Route(string Name, HapticForm Form, int Preference, HapticSinkMaker Maker);
    }

    /// <summary>The hand that holds a device or a stylus.</summary>
    public enum HapticHand
    {
        /// <summary>No hand was set.</summary>
        None = 0,

        /// <summary>The right hand.</summary>
        Right = 1,

        /// <summary>The left hand.</summary>
        Left = 2,
    }

    internal static class HapticHands
    {
        /// <summary>"left" or "right", for sentences; the hand is not None.</summary>
        public static string InWords(this HapticHand hand) => hand == HapticHand.Left ? "left" : "right";
    }

    /// <summary>The device that a wave plays on: of the sinks to try, the first whose device is there, and its queue.
    /// Main thread.</summary>
    internal sealed class HeldDevice
    {
        private readonly List<(HapticForm Form, IHapticSink Sink)> sinks = new List<(HapticForm, IHapticSink)>();

        public IHapticSink? Sink { get; private set; }

        public HapticForm Form { get; private set; }

        public HapticQueue? Queue { get; private set; }

        public bool IsThere => Sink != null && Sink.TryGetCapabilities(out _);

        public bool HasSinks => sinks.Count > 0;

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

        public void Flush() => Queue?.Flush(Time.realtimeSinceStartupAsDouble);

        public void Close()
        {
            Flush();
            Queue?.Dispose();
            (Queue, Sink) = (null, null);
            sinks.ForEach(each => (each.Sink as IDisposable)?.Dispose());
            sinks.Clear();
        }
    }

    /// <summary>The voices of a device output, as the source of its queue. Main thread.</summary>
    internal sealed class VoiceSource : IWaveSource
    {
        // A voice falls silent within 5 ms.
        private const double ClosingSeconds = 0.01;

        private readonly VoiceMixer mixer = new VoiceMixer();
        private readonly float[] closing = new float[(int)(ClosingSeconds * WaveHistory.RateHz)];

        public bool IsStopped => mixer.AllAreStopped();

        public void Add(HapticVoice voice) => mixer.Add(voice);

        public void ForEach<T>(Action<HapticVoice, T> act, T argument) => mixer.ForEach(act, argument);

        /// <summary>Renders and discards as many samples as a voice needs to fall silent.</summary>
        public void Discard() => Render(closing);

        /// <summary>Discards impacts and edges that came while no device could play them.</summary>
        public void Forget(bool staysPaused)
        {
            ForEach((voice, _) => voice.SetPaused(true), 0);
            Discard();
            ForEach((voice, stays) => voice.SetPaused(stays), staysPaused);
        }

        public void Render(Span<float> samples)
        {
            using (Markers.Render.Auto())
            {
                mixer.Render(samples, 1, 0, (int)WaveHistory.RateHz);
            }
        }
    }

    /// <summary>Until when outputs leave each hand's device to another vibration. Main thread; no garbage.</summary>
    internal static class HandYields
    {
        /// <summary>Limit of one call, in s: a mistaken length must not silence a hand for good.</summary>
        public const float MaximumSeconds = 60f;

        private static readonly double[] Until = new double[Enum.GetValues(typeof(HapticHand)).Length];

        public static void Yield(HapticHand hand, float seconds)
        {
            if (!(seconds > 0f))
            {
                return;
            }
            double until = Time.realtimeSinceStartupAsDouble + Math.Min(seconds, MaximumSeconds);
            for (int each = 0; each < Until.Length; ++each)
            {
                if (hand == HapticHand.None || each == (int)hand)
                {
                    Until[each] = Math.Max(Until[each], until);
                }
            }
        }

        /// <summary>The <see cref="Time.realtimeSinceStartupAsDouble"/> until which outputs of a hand yield.</summary>
        public static double UntilSeconds(HapticHand hand) => Until[(int)hand];

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget() => Array.Clear(Until, 0, Until.Length);
    }
}
