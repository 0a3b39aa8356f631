#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using System.Threading.Tasks;
using HaptoFlow.Model;
using HaptoFlow.Recordings;
using UnityEngine;

namespace HaptoFlow.Samples.Workshop
{
    /// <summary>Learns a material from a recording while the scene runs: ten seconds of recording, a few seconds of one
    /// core in the background. The button in the scene begins when a stylus touches it; touched again meanwhile, it
    /// cancels. The specimen beside it then feels like what was learnt.</summary>
    [RequireComponent(typeof(WorkshopScene))]
    public sealed class AddMaterialPanel : MonoBehaviour
    {
        // New text makes garbage; hands are not faster to read.
        private const double SecondsBetween = 0.25;
        private static readonly Vector3 ButtonSize = new Vector3(0.08f, 0.012f, 0.03f);
        private static readonly Vector3 TextAbove = new Vector3(0f, 0.025f, 0f);

        [SerializeField, Tooltip("A CSV table, or a WAV file whose name ends in .wav.bytes.")]
        private TextAsset? recording;

        [SerializeField, Tooltip("What belongs to the recording: its sidecar (NAME.json) and its motion file.")]
        private TextAsset[] beside = Array.Empty<TextAsset>();

        private HapticMaterial? target;
        private TextMesh? board;
        private Collider? button;
        private HapticMaterial? feel;
        private Task<HapticLearning>? starting;
        private HapticLearning? learning;
        private HapticStylus? heard;
        private bool isCancelled;
        private double nextSeconds;

        /// <summary>The text that the panel shows.</summary>
        public string Text { get; private set; } = "";

        /// <summary>A material is being learnt.</summary>
        public bool IsLearning => starting != null || learning != null;

        /// <summary>What a stylus touches to begin; null before the scene is built.</summary>
        public Collider? Button => button;

        /// <summary>Takes another recording. To be called before the panel is pressed.</summary>
        /// <param name="file">A CSV table, or a WAV file whose name ends in .wav.bytes.</param>
        /// <param name="siblings">Its sidecar and its motion file, as far as there are.</param>
        public void Take(TextAsset file, params TextAsset[] siblings)
        {
            recording = file;
            beside = siblings;
            Say("Touch to learn " + NameOf(file));
        }

        /// <summary>Begins to learn, or cancels what is under way. Returns at once.</summary>
        public void Press()
        {
            if (IsLearning)
            {
                isCancelled = true;
                learning?.Cancel();
                return;
            }
            isCancelled = false;
            HapticModelAsset? model = HaptoFlowSettings.Active.Model;
            if (recording == null || model == null)
            {
                Say(recording == null
                    ? "No recording is chosen"
                    : "No model is chosen in Project Settings > HaptoFlow");
                return;
            }
            Say("Reading " + NameOf(recording));
            starting = Begin(model.File, recording.name, recording.bytes, Beside());
        }

        private static string NameOf(TextAsset asset) => Path.GetFileNameWithoutExtension(asset.name);

        /// <summary>Reads and starts in another thread: the scene goes on.</summary>
        private static Task<HapticLearning> Begin(
            byte[] modelFile, string name, byte[] file, Dictionary<string, byte[]> beside) => Task.Run(() =>
        {
            byte[]? Sibling(string wanted) =>
                beside.TryGetValue(Path.GetFileNameWithoutExtension(wanted), out byte[] bytes) ? bytes : null;
            Recording read = RecordingReader.Read(name, file, Sibling);
            if (!read.KnowsMotion)
            {
                throw new HaptoFlowException(HaptoFlowStatus.RecordingUnusable,
                    $"{name}: speed or force is not known; expected both in its columns or in its sidecar");
            }
            return HapticLearning.Start(modelFile, read, new LearningOptions
            {
                Name = (read.Label.Length > 0 ? read.Label : read.Name).ToLowerInvariant(),
                Licence = read.Licence,
            });
        });

        private Dictionary<string, byte[]> Beside()
        {
            var files = new Dictionary<string, byte[]>();
            foreach (TextAsset each in beside)
            {
                if (each != null)
                {
                    files[each.name] = each.bytes;
                }
            }
            return files;
        }

        private void Start()
        {
            var scene = GetComponent<WorkshopScene>();
            Transform place = scene.PanelPlace;
            GameObject solid = Build.Solid("Add Material", PrimitiveType.Cube, place.position, ButtonSize,
                new Color(0.2f, 0.5f, 0.35f));
            button = solid.GetComponent<Collider>();
            feel = ScriptableObject.CreateInstance<HapticMaterial>();
            feel.name = "plastic";
            feel.Description.Label = "plastic";
            scene.Map.Insert(0, HapticMaterialRule.ForName(solid.name, feel));
            board = Build.Text("", place.position + TextAbove, place.rotation);
            target = scene.SpecimenMaterial;
            heard = scene.Pen.Stylus;
            heard.TouchBegan += OnTouchBegan;
            Say(recording != null ? "Touch to learn " + NameOf(recording) : "No recording is chosen");
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
            if (heard is { } listened)
            {
                listened.TouchBegan -= OnTouchBegan;
            }
            if (feel != null)
            {
                Destroy(feel);
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
                    if (isCancelled)
                    {
                        learning.Cancel();
                    }
                }
                else
                {
                    Say("Nothing was learnt: " + ended.Exception!.GetBaseException().Message);
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
                nextSeconds = Time.unscaledTimeAsDouble + SecondsBetween;
                Say(FormattableString.Invariant($"{100f * learning.Share:0} %: {learning.Doing}"));
            }
        }

        private void TakeOver(HapticLearning ended)
        {
            if (ended.Material == null)
            {
                Say(ended.IsCancelled ? "Cancelled" : "Nothing was learnt: " + ended.Problem);
                return;
            }
            string name = MaterialFile.Read(ended.Material).Name;
            if (target != null)
            {
                target.Description.Label = ended.NearestLabel;
                target.Carry(ended.Material);
            }
            Say($"The specimen feels like {name} now; the nearest label is {ended.NearestLabel}");
        }

        private void OnTouchBegan(HapticStylus who, in HapticContact contact)
        {
            if (contact.Collider == button)
            {
                Press();
            }
        }

        private void Say(string text)
        {
            Text = text;
            if (board != null)
            {
                board.text = text;
            }
        }
    }
}
