#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;

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

    /// <summary>A pen in one hand that a vendor's SDK knows and the Input System does not. All calls on the main thread
    /// and without garbage.</summary>
    public interface IPenDevice
    {
        /// <summary>Reads the pen. Called once a frame; must not log each time.</summary>
        /// <param name="position">Position of the tip relative to the tracking space, in metres.</param>
        /// <param name="rotation">Orientation relative to the tracking space; forward is where the tip points.</param>
        /// <param name="pressure">Pressure on the tip, 0 to 1; NaN where the pen measures none at present.</param>
        /// <returns>False while the pen is not in this hand.</returns>
        bool TryRead(out Vector3 position, out Quaternion rotation, out float pressure);
    }
}
