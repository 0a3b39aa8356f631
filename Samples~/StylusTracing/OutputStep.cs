#nullable enable
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using System;
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow.Samples.StylusTracing
{
    /// <summary>Compares outputs while the scene runs: a button gives every pen the next one, another changes what an
    /// audio output does to the wave.</summary>
    public sealed class OutputStep : MonoBehaviour
    {
        private const float StudyDelayMilliseconds = 100f;

        private static readonly Choice[] Choices =
        {
            // Without any output in the scene, each pen is felt through what its hand holds.
            new Choice("Auto Output", _ => { }),
            new Choice("Haptic Output: the audio device", owner => owner.AddComponent<HapticOutput>()),
            new Choice("Controller Waveform Output", owner => owner.AddComponent<ControllerWaveformOutput>()),
            new Choice("Controller Parametric Output, experimental at Meta", owner =>
                owner.AddComponent<ControllerParametricOutput>().UseExperimentalFeature = true),
            new Choice("Motor Output", owner => owner.AddComponent<MotorOutput>()),
        };

        private static readonly string[] Treatments =
        {
            "as it is", "compensated for a voice coil", "100 ms later", "with the exposure guard",
        };

        private readonly List<GameObject> made = new List<GameObject>();

        private ButtonPress next = null!;
        private ButtonPress treat = null!;
        private TextMesh text = null!;
        private int choice;
        private int treatment;

        /// <summary>The text that says which output is in use.</summary>
        public string Text => text.text;

        /// <param name="facing">How the text is turned.</param>
        public static OutputStep Create(Quaternion facing)
        {
            var step = new GameObject("Output Step").AddComponent<OutputStep>();
            step.text = Build.Text("", new Vector3(0f, 0.1f, 0.3f), facing);
            step.next = new ButtonPress("<Keyboard>/o", "<XRController>{RightHand}/primaryButton");
            step.treat = new ButtonPress("<Keyboard>/p", "<XRController>{RightHand}/secondaryButton");
            step.Say();
            return step;
        }

        private void Update()
        {
            if (next.IsNew())
            {
                choice = (choice + 1) % Choices.Length;
                Rebuild();
                Say();
            }
            if (treat.IsNew())
            {
                treatment = (treatment + 1) % Treatments.Length;
                made.ForEach(Treat);
                Say();
            }
        }

        private void OnDestroy()
        {
            next.Dispose();
            treat.Dispose();
        }

        private void Rebuild()
        {
            made.ForEach(Destroy);
            made.Clear();
            if (choice == 1)
            {
                Add(transform);
                return;
            }
            foreach (HapticStylus pen in FindObjectsByType<HapticStylus>(
                FindObjectsInactive.Include, FindObjectsSortMode.None))
            {
                if (choice > 0)
                {
                    Add(pen.transform);
                }
            }
        }

        private void Add(Transform parent)
        {
            var owner = new GameObject(Choices[choice].Name);
            owner.transform.SetParent(parent, false);
            Choices[choice].AddTo(owner);
            made.Add(owner);
            Treat(owner);
        }

        private void Treat(GameObject owner)
        {
            var output = owner.GetComponent<HapticOutput>();
            if (output == null)
            {
                return;
            }
            output.Processing.Actuator = treatment == 1 ? OutputActuator.VoiceCoil : OutputActuator.Uncompensated;
            output.Processing.DelayMilliseconds = treatment == 2 ? StudyDelayMilliseconds : 0f;
            output.Processing.ExposureGuard = treatment == 3;
            output.ApplyProcessing();
        }

        private void Say()
        {
            string treated = choice == 1 ? $", {Treatments[treatment]} (P: next)" : "";
            text.text = $"{Choices[choice].Name}{treated} (O: next output)";
        }

        private readonly struct Choice
        {
            public Choice(string name, Action<GameObject> addTo)
            {
                Name = name;
                AddTo = addTo;
            }

            public string Name { get; }

            public Action<GameObject> AddTo { get; }
        }
    }
}
#endif
