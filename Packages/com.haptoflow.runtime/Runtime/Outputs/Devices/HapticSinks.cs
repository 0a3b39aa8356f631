#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Outputs;

namespace HaptoFlow
{
    /// <summary>Makes the sink of one route to the device in a hand.</summary>
    /// <param name="hand">Never <see cref="HapticHand.None"/>.</param>
    public delegate IHapticSink HapticSinkMaker(HapticHand hand);

    /// <summary>The routes to devices that this project has: those of Unity itself, and those that optional packages
    /// add when they are loaded. Main thread.</summary>
    public static class HapticSinks
    {
        private static readonly List<Route> Routes = new List<Route>();

        /// <summary>Adds a route, or replaces the one of this name. To be called from a method that Unity runs when the
        /// assembly is loaded; outputs that are open already do not see it.</summary>
        /// <param name="preference">Of two routes to a device with the same form the higher one is taken. Unity's own
        /// have 0.</param>
        public static void Register(string name, HapticForm form, int preference, HapticSinkMaker maker)
        {
            Routes.RemoveAll(route => route.Name == name);
            int place = Routes.FindIndex(route => route.Preference < preference);
            Routes.Insert(place < 0 ? Routes.Count : place, new Route(name, form, preference, maker));
        }

        /// <summary>A sink for each route of a form, the preferred first.</summary>
        internal static void Open(HapticForm form, HapticHand hand, List<OpenSink> into)
        {
            foreach (Route route in Routes)
            {
                if (route.Form == form)
                {
                    into.Add(new OpenSink(form, route.Maker(hand)));
                }
            }
        }

        /// <summary>A sink and what it takes.</summary>
        internal readonly struct OpenSink
        {
            public OpenSink(HapticForm form, IHapticSink sink)
            {
                Form = form;
                Sink = sink;
            }

            public HapticForm Form { get; }

            public IHapticSink Sink { get; }
        }

        private sealed class Route
        {
            public Route(string name, HapticForm form, int preference, HapticSinkMaker maker)
            {
                Name = name;
                Form = form;
                Preference = preference;
                Maker = maker;
            }

            public string Name { get; }

            public HapticForm Form { get; }

            public int Preference { get; }

            public HapticSinkMaker Maker { get; }
        }
    }
}
