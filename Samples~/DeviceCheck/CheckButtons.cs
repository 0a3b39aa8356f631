#nullable enable
using System;
#if !(HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM) && ENABLE_LEGACY_INPUT_MANAGER
using UnityEngine;
#endif

namespace HaptoFlow.Samples.DeviceCheck
{
    /// <summary>The buttons for yes, no and skip, on the keyboard and on both controllers. Without the Input System,
    /// only the keyboard answers.</summary>
    public sealed class CheckButtons : IDisposable
    {
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
        private readonly ButtonPress yes = new ButtonPress("<Keyboard>/y",
            "<XRController>{RightHand}/primaryButton", "<XRController>{LeftHand}/primaryButton");
        private readonly ButtonPress no = new ButtonPress("<Keyboard>/n",
            "<XRController>{RightHand}/secondaryButton", "<XRController>{LeftHand}/secondaryButton");
        private readonly ButtonPress skip = new ButtonPress("<Keyboard>/s");
#endif

        /// <summary>The answer given in this frame; null without one, or with both at once. Call it once a frame.
        /// </summary>
        public bool? Take()
        {
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
            bool isYes = yes.IsNew();
            bool isNo = no.IsNew();
            return isYes == isNo ? (bool?)null : isYes;
#elif ENABLE_LEGACY_INPUT_MANAGER
            bool isYes = Input.GetKeyDown(KeyCode.Y);
            bool isNo = Input.GetKeyDown(KeyCode.N);
            return isYes == isNo ? (bool?)null : isYes;
#else
            return null;
#endif
        }

        /// <summary>True in the frame in which skip was pressed. Call it once a frame.</summary>
        public bool Skips()
        {
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
            return skip.IsNew();
#elif ENABLE_LEGACY_INPUT_MANAGER
            return Input.GetKeyDown(KeyCode.S);
#else
            return false;
#endif
        }

        /// <summary>Releases the buttons.</summary>
        public void Dispose()
        {
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
            yes.Dispose();
            no.Dispose();
            skip.Dispose();
#endif
        }
    }
}
