#nullable enable
using UnityEngine;

namespace HaptoFlow
{
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

        /// <summary>True once the device was recognised; until <see cref="Forget"/>.</summary>
        public bool IsRecognised { get; private set; }

        /// <summary>Call it repeatedly while a device that calls itself a Touch controller is in the hand.</summary>
        /// <param name="stick">The thumbstick, within +-1 on each axis.</param>
        /// <param name="touched">True while a thumb touches the stick.</param>
        /// <param name="nowSeconds">Time of a real-time clock, in s.</param>
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

        /// <summary>Starts over: another device is in the hand.</summary>
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
