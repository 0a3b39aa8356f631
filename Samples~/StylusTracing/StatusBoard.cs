#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.Samples.StylusTracing
{
    /// <summary>Says in the scene what a stylus touches, or why there are no haptics.</summary>
    public sealed class StatusBoard : MonoBehaviour
    {
        // New text makes garbage; hands are not faster to read.
        private const double SecondsBetween = 0.25;

        private TextMesh text = null!;
        private HapticStylus stylus = null!;
        private string idle = "";
        private double nextSeconds;

        /// <param name="idle">What it says while nothing is touched.</param>
        public static StatusBoard Create(HapticStylus stylus, string idle, Vector3 position, Quaternion rotation)
        {
            TextMesh text = Build.Text(idle, position, rotation);
            var board = text.gameObject.AddComponent<StatusBoard>();
            board.text = text;
            board.stylus = stylus;
            board.idle = idle;
            return board;
        }

        /// <summary>The text that the board shows.</summary>
        public string Text => text.text;

        private void Update()
        {
            if (Time.unscaledTimeAsDouble < nextSeconds)
            {
                return;
            }
            nextSeconds = Time.unscaledTimeAsDouble + SecondsBetween;
            text.text = Haptics.Problem ?? (Haptics.IsReady ? OfTouch() : "the model is being loaded");
        }

        private string OfTouch()
        {
            if (!stylus.IsTouching)
            {
                return idle;
            }
            HapticContact contact = stylus.Contact;
            float speedMps = contact.TangentialVelocity.magnitude;
            return FormattableString.Invariant(
                $"{contact.Material?.Label}: {speedMps:0.00} m/s, {contact.ForceNewtons:0.0} N");
        }
    }
}
