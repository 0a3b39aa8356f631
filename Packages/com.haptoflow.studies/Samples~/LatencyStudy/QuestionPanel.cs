#nullable enable
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>The text that the participant reads: what to attend to, the question, when to rest.</summary>
    public sealed class QuestionPanel : MonoBehaviour
    {
        private const string Buttons = "trigger (or key Y): yes        grip (or key N): no";

        private TextMesh text = null!;

        /// <summary>The text that the panel shows.</summary>
        public string Text => text.text;

        /// <summary>Creates a panel at a place, facing the participant.</summary>
        public static QuestionPanel Create(Vector3 position, Quaternion rotation)
        {
            TextMesh made = SceneObjects.AddText("", position, rotation);
            var panel = made.gameObject.AddComponent<QuestionPanel>();
            panel.text = made;
            return panel;
        }

        /// <summary>Asks the participant to wait, before the session begins.</summary>
        public void Welcome() => text.text = "Please wait for the operator.";

        /// <summary>Says what to do in a trial, and what to attend to.</summary>
        public void Instruct(PlannedTrial trial)
        {
            string what = trial.Condition == StudyPlan.TurnOn
                ? "Attend to the moments when you SET OFF."
                : "Attend to the moments when you STOP.";
            text.text = $"{(trial.IsPractice ? "Practice. " : "")}{what}\n" +
                "Put the pen on the green marker and follow it.";
        }

        /// <summary>Asks whether the participant noticed a delay.</summary>
        public void Ask(PlannedTrial trial)
        {
            string what = trial.Condition == StudyPlan.TurnOn
                ? "When you SET OFF: did the vibration begin late?"
                : "When you STOPPED: did the vibration stop late?";
            text.text = what + "\n" + Buttons;
        }

        /// <summary>Repeats the instruction, because the pen did not follow the marker.</summary>
        public void AskToFollow(PlannedTrial trial)
        {
            Instruct(trial);
            text.text += "\nStay on the surface, and stop when the marker stops.";
        }

        /// <summary>Asks the participant to rest.</summary>
        public void Rest() => text.text = "Please lift the pen and rest. The operator will continue.";

        /// <summary>Thanks the participant at the end.</summary>
        public void Thank() => text.text = "That was all. Thank you!";
    }
}
