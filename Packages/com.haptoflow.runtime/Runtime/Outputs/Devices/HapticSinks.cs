#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Outputs;

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

        /// <summary>Names of all routes.</summary>
        internal static IReadOnlyList<string> Names() => Routes.ConvertAll(route => route.Name);

        /// <summary>Calls an action with the name, the form and the maker of each route.</summary>
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

    /// <summary>Words for hands.</summary>
    internal static class HapticHands
    {
        /// <summary>"left" or "right", for sentences; the hand is not None.</summary>
        public static string InWords(this HapticHand hand) => hand == HapticHand.Left ? "left" : "right";
    }
}
