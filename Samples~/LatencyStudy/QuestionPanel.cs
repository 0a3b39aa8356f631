#nullable enable
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>What the participant reads: what to attend to, the question, when to rest.</summary>
    public sealed class QuestionPanel : MonoBehaviour
    {
        private const string Buttons = "trigger (or key Y): yes        grip (or key N): no";

        private TextMesh text = null!;

        /// <summary>What it shows.</summary>
        public string Text => text.text;

        /// <summary>A panel at a place, facing the participant.</summary>
        public static QuestionPanel Create(Vector3 position, Quaternion rotation)
        {
            TextMesh made = Build.Text("", position, rotation);
            var panel = made.gameObject.AddComponent<QuestionPanel>();
            panel.text = made;
            return panel;
        }

        /// <summary>Before anything has begun.</summary>
        public void Welcome() => text.text = "Please wait for the operator.";

        /// <summary>What to do, and what to attend to.</summary>
        public void Instruct(PlannedTrial trial)
        {
            string what = trial.Condition == StudyPlan.TurnOn
                ? "Attend to the moments when you SET OFF."
                : "Attend to the moments when you STOP.";
            text.text = $"{(trial.IsPractice ? "Practice. " : "")}{what}\n" +
                "Put the pen on the green marker and follow it.";
        }

        /// <summary>Asks whether a delay was noticed.</summary>
        public void Ask(PlannedTrial trial)
        {
            string what = trial.Condition == StudyPlan.TurnOn
                ? "When you SET OFF: did the vibration begin late?"
                : "When you STOPPED: did the vibration stop late?";
            text.text = what + "\n" + Buttons;
        }

        /// <summary>The trial begins again, since the pen did not follow.</summary>
        public void AskToFollow(PlannedTrial trial)
        {
            Instruct(trial);
            text.text += "\nStay on the surface, and stop when the marker stops.";
        }

        /// <summary>A pause.</summary>
        public void Rest() => text.text = "Please lift the pen and rest. It goes on with the operator.";

        /// <summary>The end.</summary>
        public void Thank() => text.text = "That was all. Thank you!";
    }
}
