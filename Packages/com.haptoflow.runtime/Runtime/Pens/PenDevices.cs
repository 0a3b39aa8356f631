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

    /// <summary>Recognises an MX Ink that the headset presents as a Touch controller, as it does in applications without
    /// an interaction profile for the pen. Main thread; no garbage until it is recognised.</summary>
    /// <remarks>In that form, by Logitech's description, the thumbstick's x axis carries the force of the tip, 1 for a tip
    /// in the air. No thumb holds a real stick there without touching it.</remarks>
    internal sealed class DisguisedMxInk
    {
        private const float MinimumX = 0.98f;
        private const float MaximumY = 0.1f;
        private const double SteadySeconds = 0.5;

        private static bool hasSaid;
        private double sinceSeconds = double.NaN;

        public bool IsRecognised { get; private set; }

        /// <summary>Call it repeatedly while a device that calls itself a Touch controller is in the hand.</summary>
        /// <param name="stick">The thumbstick, within +-1 on each axis.</param>
        public void Note(Vector2 stick, bool touched, double nowSeconds)
        {
            bool isSign = !touched && stick.x >= MinimumX && Mathf.Abs(stick.y) <= MaximumY;
            if (!isSign)
            {
                sinceSeconds = double.NaN;
            }
            else if (double.IsNaN(sinceSeconds))
            {
                sinceSeconds = nowSeconds;
            }
            else if (!IsRecognised && nowSeconds - sinceSeconds >= SteadySeconds)
            {
                IsRecognised = true;
                Say();
            }
        }

        public void Forget()
        {
            IsRecognised = false;
            sinceSeconds = double.NaN;
        }

        private static void Say()
        {
            if (!hasSaid)
            {
                hasSaid = true;
                Debug.LogWarning("HaptoFlow: a controller in a hand behaves like an MX Ink that the headset presents as " +
                    "a Touch controller. So its tip's force is unknown (the spring model is used), and its tip is taken " +
                    "to be where a controller points. " + MissingProfile);
            }
        }

        /// <summary>What such a project lacks, and where to get it.</summary>
        public const string MissingProfile = "With Unity's OpenXR plug-in, switch on MX Ink Stylus (HaptoFlow) under " +
            "Project Settings > XR Plug-in Management > OpenXR, Enabled Interaction Profiles. With Meta's SDK, import " +
            "Logitech's integration package for Unity (logitech.github.io/mxink) and add its action set under Project " +
            "Settings > Meta XR > Input Actions.";

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Reset() => hasSaid = false;
    }
}
