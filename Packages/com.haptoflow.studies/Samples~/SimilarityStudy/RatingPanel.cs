#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>The question and its seven answers in front of the participant. An answer counts only when it has been
    /// chosen and then confirmed, so that a single press by mistake does not count. The buttons are on the controller in the
    /// hand without the pen and on the keyboard; without the Input System, only the keyboard answers.</summary>
    public sealed class RatingPanel : MonoBehaviour
    {
        public const int Lowest = 1;
        public const int Highest = 7;
        public const string Question = "How similar are these objects?";

        private const float SpacingMetres = 0.035f;
        private static readonly Color NormalColour = Color.white;
        private static readonly Color ChosenColour = new Color(0.95f, 0.85f, 0.2f);

        private readonly TextMesh[] numbers = new TextMesh[Highest];
        private readonly ButtonPress[] keys = new ButtonPress[Highest];
        private GameObject texts = null!;
        private ButtonPress lower = null!;
        private ButtonPress higher = null!;
        private ButtonPress confirm = null!;

        /// <summary>Raised when the participant confirms an answer, 1 to 7.</summary>
        public event Action<int>? Confirmed;

        /// <summary>The chosen answer, 1 to 7; null before one is chosen.</summary>
        public int? Choice { get; private set; }

        public bool IsOpen => texts.activeSelf;

        /// <param name="penHand">The hand that holds the pen; the other one answers.</param>
        public static RatingPanel Create(Vector3 position, Quaternion facing, PenHand penHand)
        {
            var panel = new GameObject("Rating Panel").AddComponent<RatingPanel>();
            panel.transform.SetPositionAndRotation(position, facing);
            panel.texts = new GameObject("Texts");
            panel.texts.transform.SetParent(panel.transform, false);
            panel.Add(Question, new Vector3(0f, 0.035f, 0f));
            for (int answer = Lowest; answer <= Highest; ++answer)
            {
                float x = (answer - 0.5f * (Lowest + Highest)) * SpacingMetres;
                panel.numbers[answer - 1] = panel.Add($"{answer}", new Vector3(x, 0f, 0f));
                panel.keys[answer - 1] = new ButtonPress("<Keyboard>/" + answer);
            }
            panel.Add("1: not similar at all          7: extremely similar", new Vector3(0f, -0.03f, 0f));
            panel.Add("two buttons, or 1 to 7: choose\ntrigger, or Enter: confirm", new Vector3(0f, -0.065f, 0f));
            string hand = ButtonPress.ControllerOppositeTo(penHand);
            panel.lower = new ButtonPress("<Keyboard>/leftArrow", hand + "primaryButton");
            panel.higher = new ButtonPress("<Keyboard>/rightArrow", hand + "secondaryButton");
            panel.confirm = new ButtonPress("<Keyboard>/enter", hand + "triggerPressed");
            panel.Close();
            return panel;
        }

        public void Open()
        {
            Choice = null;
            Show();
            texts.SetActive(true);
        }

        public void Close() => texts.SetActive(false);

        /// <summary>Chooses an answer while the question is shown, until one is confirmed.</summary>
        public void Choose(int answer)
        {
            if (IsOpen && answer >= Lowest && answer <= Highest)
            {
                Choice = answer;
                Show();
            }
        }

        /// <summary>Chooses the next lower or higher answer; without a chosen one, the middle one.</summary>
        /// <param name="step">-1 or 1.</param>
        public void Move(int step) => Choose(Choice.HasValue
            ? Math.Max(Lowest, Math.Min(Highest, Choice.Value + step))
            : (Lowest + Highest) / 2);

        /// <summary>Confirms the chosen answer. Does nothing when none is chosen.</summary>
        public void Confirm()
        {
            if (IsOpen && Choice.HasValue)
            {
                int answer = Choice.Value;
                Close();
                Confirmed?.Invoke(answer);
            }
        }

        private void Update()
        {
            for (int answer = Lowest; answer <= Highest; ++answer)
            {
                if (keys[answer - 1].IsNew())
                {
                    Choose(answer);
                }
            }
            // All buttons are read in every frame, so that a button held while the panel opens does not count as new.
            bool isLower = lower.IsNew();
            bool isHigher = higher.IsNew();
            bool isConfirmed = confirm.IsNew();
            if (isLower != isHigher)
            {
                Move(isLower ? -1 : 1);
            }
            if (isConfirmed)
            {
                Confirm();
            }
        }

        private void OnDestroy()
        {
            lower.Dispose();
            higher.Dispose();
            confirm.Dispose();
            Array.ForEach(keys, each => each.Dispose());
        }

        private TextMesh Add(string text, Vector3 place)
        {
            TextMesh made = SceneObjects.AddText(text, Vector3.zero, Quaternion.identity);
            made.transform.SetParent(texts.transform, false);
            made.transform.localPosition = place;
            return made;
        }

        private void Show()
        {
            for (int answer = Lowest; answer <= Highest; ++answer)
            {
                numbers[answer - 1].color = Choice == answer ? ChosenColour : NormalColour;
            }
        }
    }
}
