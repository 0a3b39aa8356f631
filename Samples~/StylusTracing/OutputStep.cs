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
        // Without any output in the scene, each pen is felt through what its hand holds.
        private const int Auto = 0;
        private const int Audio = 1;

        private static readonly (string Name, Action<GameObject> AddTo)[] Outputs =
        {
            ("Auto Output", _ => { }),
            ("Haptic Output: the audio device", owner => owner.AddComponent<HapticOutput>()),
            ("Controller Waveform Output", owner => owner.AddComponent<ControllerWaveformOutput>()),
            ("Controller Parametric Output, experimental at Meta", owner =>
                owner.AddComponent<ControllerParametricOutput>().UseExperimentalFeature = true),
            ("Motor Output", owner => owner.AddComponent<MotorOutput>()),
        };

        private static readonly (string Name, Action<OutputProcessing> Apply)[] Treatments =
        {
            ("as it is", _ => { }),
            ("compensated for a voice coil", processing => processing.Actuator = OutputActuator.VoiceCoil),
            ("100 ms later", processing => processing.DelayMilliseconds = 100f),
            ("with the exposure guard", processing => processing.ExposureGuard = true),
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
                choice = (choice + 1) % Outputs.Length;
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
            if (choice == Audio)
            {
                Add(transform);
            }
            else if (choice != Auto)
            {
                foreach (HapticStylus pen in FindObjectsByType<HapticStylus>(
                    FindObjectsInactive.Include, FindObjectsSortMode.None))
                {
                    Add(pen.transform);
                }
            }
        }

        private void Add(Transform parent)
        {
            var owner = new GameObject(Outputs[choice].Name);
            owner.transform.SetParent(parent, false);
            Outputs[choice].AddTo(owner);
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
            output.Processing.Actuator = OutputActuator.Uncompensated;
            output.Processing.DelayMilliseconds = 0f;
            output.Processing.ExposureGuard = false;
            Treatments[treatment].Apply(output.Processing);
            output.ApplyProcessing();
        }

        private void Say()
        {
            string treated = choice == Audio ? $", {Treatments[treatment].Name} (P: next)" : "";
            text.text = $"{Outputs[choice].Name}{treated} (O: next output)";
        }
    }
}
#endif
