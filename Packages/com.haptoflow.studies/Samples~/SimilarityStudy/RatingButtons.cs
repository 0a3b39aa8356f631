#nullable enable
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>The buttons for the answers, on the controller in the hand without the pen and on the keyboard. Without
    /// the Input System, only the keyboard answers.</summary>
    public sealed class RatingButtons : MonoBehaviour
    {
        private readonly ButtonPress[] numbers = new ButtonPress[RatingPanel.Highest];
        private RatingPanel panel = null!;
        private ButtonPress lower = null!;
        private ButtonPress higher = null!;
        private ButtonPress confirm = null!;

        /// <summary>Creates the buttons of a panel.</summary>
        /// <param name="penHand">The hand that holds the pen; the other one answers.</param>
        public static RatingButtons Create(RatingPanel panel, PenHand penHand)
        {
            string hand = ButtonPress.ControllerOppositeTo(penHand);
            // On an object of their own, because the panel is inactive while it is closed.
            var buttons = new GameObject("Rating Buttons").AddComponent<RatingButtons>();
            buttons.panel = panel;
            buttons.lower = new ButtonPress("<Keyboard>/leftArrow", hand + "primaryButton");
            buttons.higher = new ButtonPress("<Keyboard>/rightArrow", hand + "secondaryButton");
            buttons.confirm = new ButtonPress("<Keyboard>/enter", hand + "triggerPressed");
            for (int answer = RatingPanel.Lowest; answer <= RatingPanel.Highest; ++answer)
            {
                buttons.numbers[answer - 1] = new ButtonPress("<Keyboard>/" + answer);
            }
            return buttons;
        }

        private void Update()
        {
            for (int answer = RatingPanel.Lowest; answer <= RatingPanel.Highest; ++answer)
            {
                if (numbers[answer - 1].IsNew())
                {
                    panel.Choose(answer);
                }
            }
            // All buttons are read in every frame, so that a button held while the panel opens does not count as new.
            bool isLower = lower.IsNew();
            bool isHigher = higher.IsNew();
            bool isConfirmed = confirm.IsNew();
            if (isLower != isHigher)
            {
                panel.Move(isLower ? -1 : 1);
            }
            if (isConfirmed)
            {
                panel.Confirm();
            }
        }

        private void OnDestroy()
        {
            lower.Dispose();
            higher.Dispose();
            confirm.Dispose();
            foreach (ButtonPress each in numbers)
            {
                each.Dispose();
            }
        }
    }
}
