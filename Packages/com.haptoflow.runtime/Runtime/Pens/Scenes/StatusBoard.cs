#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Shows which label a stylus touches, how fast and how hard, or why there are no haptics.</summary>
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "status-board")]
    public sealed class StatusBoard : MonoBehaviour
    {
        // Every new text allocates; four a second are enough to read.
        private const double UpdateSeconds = 0.25;

        private TextMesh text = null!;
        private HapticStylus stylus = null!;
        private string idleText = "";
        private double nextUpdateSeconds;

        /// <summary>The text that the board shows.</summary>
        public string Text => text.text;

        /// <summary>Creates a board. Main thread, in play mode.</summary>
        /// <param name="idleText">The text that is shown while the stylus touches nothing.</param>
        public static StatusBoard Create(HapticStylus stylus, string idleText, Vector3 position, Quaternion rotation)
        {
            TextMesh text = SceneObjects.AddText(idleText, position, rotation);
            var board = text.gameObject.AddComponent<StatusBoard>();
            board.text = text;
            board.stylus = stylus;
            board.idleText = idleText;
            return board;
        }

        private void Update()
        {
            if (Time.unscaledTimeAsDouble < nextUpdateSeconds)
            {
                return;
            }
            nextUpdateSeconds = Time.unscaledTimeAsDouble + UpdateSeconds;
            text.text = Haptics.Problem ?? (Haptics.IsReady ? DescribeTouch() : "the model is being loaded");
        }

        private string DescribeTouch()
        {
            if (!stylus.IsTouching)
            {
                return idleText;
            }
            HapticContact contact = stylus.Contact;
            float speedMps = contact.TangentialVelocity.magnitude;
            return FormattableString.Invariant(
                $"{contact.Material?.Label}: {speedMps:0.00} m/s, {contact.ForceNewtons:0.0} N");
        }
    }
}
