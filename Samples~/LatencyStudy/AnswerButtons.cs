#nullable enable
using System;
#if !(HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM) && ENABLE_LEGACY_INPUT_MANAGER
using UnityEngine;
#endif

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>The buttons for yes and no, on the controller in the hand without the pen and on the keyboard. Without
    /// the Input System, only the keyboard answers.</summary>
    public sealed class AnswerButtons : IDisposable
    {
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
        private readonly ButtonPress yes;
        private readonly ButtonPress no;

        /// <param name="penHand">The hand that holds the pen; the other one answers.</param>
        public AnswerButtons(PenHand penHand)
        {
            string controller = ButtonPress.ControllerOppositeTo(penHand);
            yes = new ButtonPress("<Keyboard>/y", controller + "triggerPressed");
            no = new ButtonPress("<Keyboard>/n", controller + "gripPressed");
        }

        /// <summary>The answer given in this frame; null without one, or with both at once. Call it once a frame.
        /// </summary>
        public bool? Take()
        {
            bool isYes = yes.IsNew();
            bool isNo = no.IsNew();
            return isYes == isNo ? (bool?)null : isYes;
        }

        /// <summary>Releases the buttons.</summary>
        public void Dispose()
        {
            yes.Dispose();
            no.Dispose();
        }
#else
        /// <param name="penHand">Not used without the Input System.</param>
        public AnswerButtons(PenHand penHand)
        {
        }

        /// <summary>The answer given in this frame; null without one, or with both at once. Call it once a frame.
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

        /// <summary>Does nothing without the Input System.</summary>
        public void Dispose()
        {
        }
#endif
    }
}
