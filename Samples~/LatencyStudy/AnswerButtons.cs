#nullable enable
using System;
#if !(HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM) && ENABLE_LEGACY_INPUT_MANAGER
using UnityEngine;
#endif

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>Yes and no: on the controller in the hand without the pen, and on the keyboard.</summary>
    public sealed class AnswerButtons : IDisposable
    {
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
        private readonly ButtonPress yes;
        private readonly ButtonPress no;

        /// <param name="penHand">The other hand answers.</param>
        public AnswerButtons(PenHand penHand)
        {
            string controller = "<XRController>{" + (penHand == PenHand.Right ? "Left" : "Right") + "Hand}/";
            yes = new ButtonPress("<Keyboard>/y", controller + "triggerPressed");
            no = new ButtonPress("<Keyboard>/n", controller + "gripPressed");
        }

        /// <summary>An answer that was given in this frame; null without one, or with both at once. Once a frame.
        /// </summary>
        public bool? Take()
        {
            bool isYes = yes.IsNew();
            bool isNo = no.IsNew();
            return isYes == isNo ? (bool?)null : isYes;
        }

        /// <summary>Lets go of the buttons.</summary>
        public void Dispose()
        {
            yes.Dispose();
            no.Dispose();
        }
#else
        /// <param name="penHand">Without the Input System only the keyboard answers.</param>
        public AnswerButtons(PenHand penHand)
        {
        }

        /// <summary>An answer that was given in this frame; null without one, or with both at once. Once a frame.
        /// </summary>
        public bool? Take()
        {
#if ENABLE_LEGACY_INPUT_MANAGER
            bool isYes = Input.GetKeyDown(KeyCode.Y);
            bool isNo = Input.GetKeyDown(KeyCode.N);
            return isYes == isNo ? (bool?)null : isYes;
#else
            return null;
#endif
        }

        /// <summary>Nothing is held.</summary>
        public void Dispose()
        {
        }
#endif
    }
}
