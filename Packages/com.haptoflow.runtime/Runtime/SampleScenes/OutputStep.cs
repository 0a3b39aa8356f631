#nullable enable
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using System;
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow.SampleScenes
{
    /// <summary>Compares outputs while the scene runs: one button switches every pen to the next output, another one
    /// switches the processing of an audio output.</summary>
    internal sealed class OutputStep : MonoBehaviour
    {
        // Without any output in the scene, Auto Output plays each pen on the device in its hand.
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

        private static readonly (string Name, Action<OutputProcessing> Apply)[] Processings =
        {
            ("as it is", _ => { }),
            ("compensated for a voice coil", processing => processing.Actuator = OutputActuator.VoiceCoil),
            ("100 ms later", processing => processing.DelayMilliseconds = 100f),
            ("with the exposure guard", processing => processing.ExposureGuard = true),
        };

        private readonly List<GameObject> outputs = new List<GameObject>();

        private ButtonPress nextOutput = null!;
        private ButtonPress nextProcessing = null!;
        private TextMesh text = null!;
        private int outputChoice;
        private int processingChoice;

        public string Text => text.text;

        public static OutputStep Create(Quaternion facing)
        {
            var step = new GameObject("Output Step").AddComponent<OutputStep>();
            step.text = SceneObjects.AddText("", new Vector3(0f, 0.1f, 0.3f), facing);
            step.nextOutput = new ButtonPress("<Keyboard>/o", "<XRController>{RightHand}/primaryButton");
            step.nextProcessing = new ButtonPress("<Keyboard>/p", "<XRController>{RightHand}/secondaryButton");
            step.ShowChoice();
            return step;
        }

        private void Update()
        {
            if (nextOutput.IsNew())
            {
                outputChoice = (outputChoice + 1) % Outputs.Length;
                Rebuild();
                ShowChoice();
            }
            if (nextProcessing.IsNew())
            {
                processingChoice = (processingChoice + 1) % Processings.Length;
                outputs.ForEach(ApplyProcessing);
                ShowChoice();
            }
        }

        private void OnDestroy()
        {
            nextOutput.Dispose();
            nextProcessing.Dispose();
        }

        private void Rebuild()
        {
            outputs.ForEach(Destroy);
            outputs.Clear();
            if (outputChoice == Auto)
            {
                return;
            }
            HapticOutput? audio = outputChoice == Audio ? Add(transform).GetComponent<HapticOutput>() : null;
            foreach (HapticStylus pen in FindObjectsByType<HapticStylus>(
                FindObjectsInactive.Include, FindObjectsSortMode.None))
            {
                pen.Output = audio;
                if (audio == null)
                {
                    Add(pen.transform);
                }
            }
        }

        private GameObject Add(Transform parent)
        {
            var owner = new GameObject(Outputs[outputChoice].Name);
            owner.transform.SetParent(parent, false);
            Outputs[outputChoice].AddTo(owner);
            outputs.Add(owner);
            ApplyProcessing(owner);
            return owner;
        }

        private void ApplyProcessing(GameObject owner)
        {
            var output = owner.GetComponent<HapticOutput>();
            if (output == null)
            {
                return;
            }
            output.Processing.Actuator = OutputActuator.Uncompensated;
            output.Processing.DelayMilliseconds = 0f;
            output.Processing.ExposureGuard = false;
            Processings[processingChoice].Apply(output.Processing);
            output.ApplyProcessing();
        }

        private void ShowChoice()
        {
            string processing = outputChoice == Audio ? $", {Processings[processingChoice].Name} (P: next)" : "";
            text.text = $"{Outputs[outputChoice].Name}{processing} (O: next output)";
        }
    }
}
#endif
