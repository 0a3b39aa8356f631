#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using System.Threading.Tasks;
using HaptoFlow.Model;
using HaptoFlow.Recordings;
using UnityEngine;

namespace HaptoFlow.SampleScenes
{
    /// <summary>Learns a material from a recording of ten seconds while the scene runs, which takes a few seconds of
    /// one core in the background. A stylus that touches the button starts the learning, or cancels it. The specimen
    /// beside the button then takes the learnt material.</summary>
    [RequireComponent(typeof(WorkshopScene))]
    internal sealed class AddMaterialPanel : MonoBehaviour
    {
        // Every new text allocates; four a second are enough to read.
        private const double UpdateSeconds = 0.25;
        private static readonly Vector3 ButtonSize = new Vector3(0.08f, 0.012f, 0.03f);
        private static readonly Vector3 TextAbove = new Vector3(0f, 0.025f, 0f);

        [SerializeField, Tooltip("The recording is a CSV table, or a WAV file whose name ends in .wav.bytes.")]
        private TextAsset? recording;

        [SerializeField, Tooltip("The companion files of the recording are its sidecar (NAME.json) and its motion " +
            "file.")]
        private TextAsset[] beside = Array.Empty<TextAsset>();

        private HapticMaterial? target;
        private TextMesh? board;
        private HapticMaterial? buttonMaterial;
        private Task<HapticLearning>? starting;
        private HapticLearning? learning;
        private HapticStylus? stylus;
        private bool isCancelRequested;
        private double nextSeconds;

        public string Text { get; private set; } = "";

        public bool IsLearning => starting != null || learning != null;

        /// <summary>The button that starts the learning; null before the scene is built.</summary>
        public Collider? Button { get; private set; }

        /// <summary>Sets another recording. Call it before the button is touched.</summary>
        public void SetRecording(TextAsset file, params TextAsset[] siblings)
        {
            recording = file;
            beside = siblings;
            Show("Touch to learn " + NameOf(file));
        }

        /// <summary>Starts the learning, or cancels a running one. Returns at once.</summary>
        public void Press()
        {
            if (IsLearning)
            {
                isCancelRequested = true;
                learning?.Cancel();
                return;
            }
            isCancelRequested = false;
            HapticModelAsset? model = HaptoFlowSettings.Active.Model;
            if (recording == null || model == null)
            {
                Show(recording == null
                    ? "No recording is chosen"
                    : "No model is chosen in Project Settings > HaptoFlow");
                return;
            }
            Show("Reading " + NameOf(recording));
            // Unity leaves out the last ending of an asset's file, such as .csv or the .bytes of .wav.bytes.
            string name = Path.HasExtension(recording.name) ? recording.name : recording.name + ".csv";
            starting = Begin(model.File, name, ReadFiles(name));
        }

        private static string NameOf(TextAsset asset) => Path.GetFileNameWithoutExtension(asset.name);

        /// <summary>Reads the recording and learns in another thread, so that the scene continues.</summary>
        private static Task<HapticLearning> Begin(
            byte[] modelFile, string name, Dictionary<string, byte[]> files) => Task.Run(
            () => HapticLearning.Start(modelFile, RecordingReader.Read(name, files), new LearningOptions()));

        private Dictionary<string, byte[]> ReadFiles(string name)
        {
            var files = new Dictionary<string, byte[]>();
            foreach (TextAsset each in beside)
            {
                if (each != null)
                {
                    // A sidecar or a motion file: the recording reads the one that it needs.
                    files[each.name + ".json"] = each.bytes;
                    files[each.name + ".csv"] = each.bytes;
                }
            }
            files[name] = recording!.bytes;
            return files;
        }

        private void Start()
        {
            var scene = GetComponent<WorkshopScene>();
            Transform place = scene.PanelPlace;
            GameObject solid = SceneObjects.AddSolid("Add Material", PrimitiveType.Cube, place.position, ButtonSize,
                new Color(0.2f, 0.5f, 0.35f));
            Button = solid.GetComponent<Collider>();
            buttonMaterial = ScriptableObject.CreateInstance<HapticMaterial>();
            buttonMaterial.name = "plastic";
            buttonMaterial.Description.Label = "plastic";
            scene.Map.Insert(0, HapticMaterialRule.ForName(solid.name, buttonMaterial));
            board = SceneObjects.AddText("", place.position + TextAbove, place.rotation);
            target = scene.SpecimenMaterial;
            stylus = scene.Pen.Stylus;
            stylus.TouchBegan += OnTouchBegan;
            Show(recording != null ? "Touch to learn " + NameOf(recording) : "No recording is chosen");
        }

        private void OnDisable()
        {
            learning?.Cancel();
            starting?.ContinueWith(started => started.Result.Cancel(), TaskContinuationOptions.OnlyOnRanToCompletion);
            starting = null;
            learning = null;
        }

        private void OnDestroy()
        {
            if (stylus is { } subscribed)
            {
                subscribed.TouchBegan -= OnTouchBegan;
            }
            if (buttonMaterial != null)
            {
                Destroy(buttonMaterial);
            }
        }

        private void Update()
        {
            if (starting != null && starting.IsCompleted)
            {
                Task<HapticLearning> ended = starting;
                starting = null;
                if (ended.Status == TaskStatus.RanToCompletion)
                {
                    learning = ended.Result;
                    if (isCancelRequested)
                    {
                        learning.Cancel();
                    }
                }
                else
                {
                    Show("Nothing was learnt: " + ended.Exception!.GetBaseException().Message);
                }
            }
            if (learning == null)
            {
                return;
            }
            if (learning.IsCompleted)
            {
                HapticLearning ended = learning;
                learning = null;
                TakeOver(ended);
            }
            else if (Time.unscaledTimeAsDouble >= nextSeconds)
            {
                nextSeconds = Time.unscaledTimeAsDouble + UpdateSeconds;
                Show(FormattableString.Invariant($"{100f * learning.Share:0} %: {learning.Doing}"));
            }
        }

        private void TakeOver(HapticLearning ended)
        {
            if (ended.Material == null)
            {
                Show(ended.IsCancelled ? "Cancelled" : "Nothing was learnt: " + ended.Problem);
                return;
            }
            string name = MaterialFile.Read(ended.Material).Name;
            if (target != null)
            {
                target.Description.Label = ended.NearestLabel;
                target.Carry(ended.Material);
            }
            Show($"The specimen now feels like {name}; the nearest label is {ended.NearestLabel}");
        }

        private void OnTouchBegan(HapticStylus who, in HapticContact contact)
        {
            if (contact.Collider == Button)
            {
                Press();
            }
        }

        private void Show(string text)
        {
            Text = text;
            if (board != null)
            {
                board.text = text;
            }
        }
    }
}
