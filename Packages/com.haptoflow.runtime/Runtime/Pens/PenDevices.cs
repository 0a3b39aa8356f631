#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow
{
    /// <summary>The pens of vendors' SDKs, which optional assemblies register when loaded. Main thread.</summary>
    public static class PenDevices
    {
        private static readonly Dictionary<string, Func<PenHand, IPenDevice>> Makers =
            new Dictionary<string, Func<PenHand, IPenDevice>>();

        /// <summary>Adds a kind of pen, or replaces the one of the same name. Call it from a method that Unity runs when
        /// the assembly is loaded; an <see cref="XrPen"/> that is already enabled does not use the new kind.</summary>
        public static void Register(string name, Func<PenHand, IPenDevice> maker) => Makers[name] = maker;

        internal static IPenDevice[] Open(PenHand hand)
        {
            var opened = new List<IPenDevice>();
            foreach (Func<PenHand, IPenDevice> maker in Makers.Values)
            {
                opened.Add(maker(hand));
            }
            return opened.ToArray();
        }
    }
}
